#include "scenario_mutator.hpp"

#include <credence/text.hpp>
#include <credence/detail/worlds.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);

namespace credence::fuzz {

namespace {

using Random = std::minstd_rand;

template <class List>
const auto& one_of(const List& list, Random& random) {
    return list[random() % std::size(list)];
}

std::string any_number(Random& random) {
    static const std::string numbers[] = {"0", "-0", "1", "2", "3", "0.5", "-1", "3.2", "-3.2", "10", "100", "101",
                                          "1e-200", "1e-300", "1e9", "1.1e9", "1e400", "inf", "-inf", "nan", "0.1", "8",
                                          "99999", "1e5"};
    return one_of(numbers, random);
}

/// Keys of every world, and the key of the world itself.
const std::vector<DescribedKey>& all_keys() {
    static const std::vector<DescribedKey> keys = [] {
        std::vector<DescribedKey> found;
        std::string names;
        for (const World* world : all_worlds()) {
            for (const DescribedKey& key : world->keys()) found.push_back(key);
            names += (names.empty() ? "" : ", ") + world->name();
        }
        found.push_back({"scenario.world", "", names});
        return found;
    }();
    return keys;
}

/// Words of choices stand in a key's help; lists need more.
std::string any_value(const DescribedKey& key, Random& random) {
    static const std::string values[] = {"default",
                                         "none",
                                         "chain",
                                         "all",
                                         "0-1",
                                         "0-1, 1-2",
                                         "1-0",
                                         "0-1, 0-1",
                                         "0-63",
                                         "0 0, 1 1",
                                         "1 2",
                                         "fixed",
                                         "greedy, fixed",
                                         "fixed, fixed",
                                         "ekf",
                                         "kf",
                                         "ekf, kf",
                                         "fixed.ekf 1",
                                         "greedy.kf 2, fixed.kf 3",
                                         "a.b 1",
                                         "run",
                                         "dm",
                                         "\xc3\xa9"};
    switch (random() % 4) {
        case 0: return one_of(values, random);
        case 1: {
            const std::vector<std::string> words = split_list(key.help);
            return words.empty() ? "" : one_of(words, random);
        }
        case 2: return any_number(random) + ", " + any_number(random);
        default: return any_number(random);
    }
}

}  // namespace

std::size_t mutate_scenario(std::uint8_t* text, std::size_t size, std::size_t room, unsigned seed) {
    Random random(seed);
    if (random() % 2 == 0) return LLVMFuzzerMutate(text, size, room);
    const DescribedKey& key = one_of(all_keys(), random);
    const std::string more = override_separator + key.key + "=" + any_value(key, random);
    // In the place of what was overridden before, now and then, so that texts do not only grow.
    const std::uint8_t* end = std::find(text, text + size, static_cast<std::uint8_t>(override_separator));
    if (random() % 2 == 0) size = static_cast<std::size_t>(end - text);
    if (size + more.size() > room) return LLVMFuzzerMutate(text, size, room);
    std::copy(more.begin(), more.end(), text + size);
    return size + more.size();
}

}  // namespace credence::fuzz
