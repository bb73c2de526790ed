#include <credence/own_keys.hpp>

#include <credence/text.hpp>

#include "worlds/values.hpp"

namespace credence {

namespace {

const std::vector<KeyOf<OwnBasics>>& common_keys() {
    static const std::vector<KeyOf<OwnBasics>> keys = [] {
        std::vector<KeyOf<OwnBasics>> common;
        add_common_keys(common);
        return common;
    }();
    return keys;
}

}  // namespace

std::vector<DescribedKey> basic_keys(const OwnBasics& basics) {
    std::vector<DescribedKey> described;
    for (const KeyOf<OwnBasics>& key : common_keys())
        described.push_back({key.name, key.get(basics), key.help, key.choices});
    return described;
}

bool set_basic(OwnBasics& basics, const std::string& key, const std::string& value) {
    for (const KeyOf<OwnBasics>& common : common_keys()) {
        if (common.name != key) continue;
        common.set(basics, value);
        return true;
    }
    return false;
}

double own_real(const std::string& key, const std::string& text, double low, double high) {
    return parse_real(key, text, between(low, high));
}

int own_integer(const std::string& key, const std::string& text, int low, int high) {
    return static_cast<int>(parse_integer(key, text, low, high));
}

std::size_t own_choice(const std::string& key, const std::string& text, const std::vector<std::string>& choices) {
    return parse_choice(key, text, choices);
}

std::string own_text(double value) { return to_text(value); }

void refuse_unknown_key(const std::string& key, const std::vector<std::string>& known) {
    const std::string meant = closest(key, known);
    throw InputError("unknown key " + printable(key) + ". " +
                         (meant.empty() ? "The keys are " + joined(known) + "." : "Did you mean " + meant + "?"),
                     key);
}

}  // namespace credence
