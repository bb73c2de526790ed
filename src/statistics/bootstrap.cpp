#include <algorithm>
#include <cmath>
#include "statistics/bootstrap.hpp"
#include <credence/detail/draws.hpp>
#include <credence/detail/each.hpp>

#include "base/idle_threads.hpp"
#include "base/nan.hpp"

namespace credence {

namespace {

constexpr std::size_t resampled_trials = 256, fewest_blocks = 100;

/// 64-bit FNV-1a [Fowler, Noll, Vo].
std::uint64_t fnv1a(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char letter : text) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
    return hash;
}

/// The random words of one resample: SplitMix64 [Steele, Lea, Flood 2014], the finaliser of a counter times the golden
/// ratio, starting from a key. The key is a Philox block: its key is the root seed, its counter the resample and the
/// hash of the column's name, with source 15 at the position of draws.hpp's source: no trial's noise uses that source.
/// (Philox for every index takes three times as long.)
class Words {
public:
    Words(std::uint64_t root_seed, const std::string& column, int resample) {
        const PhiloxKeys keys(static_cast<std::uint32_t>(root_seed), static_cast<std::uint32_t>(root_seed >> 32));
        const std::uint64_t hash = fnv1a(column);
        const auto block = philox<std::uint64_t>(
            {{0, static_cast<std::uint64_t>(resample), hash & 0xffffffff, hash >> 32 | 0xf0000}}, keys);
        key_ = (block.word[0] & 0xffffffff) << 32 | (block.word[1] & 0xffffffff);
    }

    /// 64 bits: two words of 32.
    std::uint64_t operator()(std::uint64_t position) const {
        std::uint64_t z = key_ + (position + 1) * 0x9e3779b97f4a7c15u;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        return z ^ z >> 31;
    }

private:
    std::uint64_t key_ = 0;
};

/// The resampled item: one trial's value.
struct TrialPart {
    double sum = 0;

    void operator+=(const TrialPart& other) { sum += other.sum; }
    double mean(std::size_t drawn) const { return sum / static_cast<double>(drawn); }
};

/// The resampled item: a block's sum and count.
struct BlockPart {
    double sum = 0, count = 0;

    void operator+=(const BlockPart& other) {
        sum += other.sum;
        count += other.count;
    }
    double mean(std::size_t) const { return sum / count; }
};

/// The mean of one resample. Four running sums, position p added to number p mod 4, hide the latency of adding.
template <class Part>
double resampled_mean(const std::vector<Part>& parts, const Words& words) {
    const std::uint64_t size = parts.size();
    const auto low = [&](std::uint64_t word) { return parts[((word & 0xffffffff) * size) >> 32]; };
    const auto high = [&](std::uint64_t word) { return parts[((word >> 32) * size) >> 32]; };
    Part total[4]{};
    for (std::uint64_t pair = 0; pair < size / 4 * 2; pair += 2) {
        const std::uint64_t one = words(pair), other = words(pair + 1);
        total[0] += low(one);
        total[1] += high(one);
        total[2] += low(other);
        total[3] += high(other);
    }
    for (std::uint64_t position = size / 4 * 4; position < size; ++position) total[0] += low(words(position));
    total[0] += total[1];
    total[2] += total[3];
    total[0] += total[2];
    return total[0].mean(size);
}

template <class Part>
std::vector<double> resampled_means(const std::vector<Part>& parts, std::uint64_t root_seed,
                                    const std::string& column) {
    std::vector<double> means(bootstrap_resamples);
    // Threads are worth starting for some milliseconds of work.
    const bool worth_threads = parts.size() > 4000;
#pragma omp parallel for schedule(static) if (worth_threads)
    for (int b = 0; b < bootstrap_resamples; ++b)
        means[static_cast<std::size_t>(b)] = resampled_mean(parts, Words(root_seed, column, b));
    if (worth_threads) end_idle_threads();
    return means;
}

/// Sum of value - `centre` and count of every block that holds a value.
std::vector<BlockPart> blocks_of(const std::vector<double>& by_trial, double centre) {
    std::vector<BlockPart> blocks;
    for (std::size_t first = 0; first < by_trial.size(); first += resampled_trials) {
        BlockPart block;
        for (std::size_t i = first; i < std::min(by_trial.size(), first + resampled_trials); ++i)
            if (!std::isnan(by_trial[i])) block += {by_trial[i] - centre, 1};
        if (block.count > 0) blocks.push_back(block);
    }
    return blocks;
}

std::vector<TrialPart> trials_of(const std::vector<double>& by_trial, double centre) {
    std::vector<TrialPart> trials;
    for (const double value : by_trial)
        if (!std::isnan(value)) trials.push_back({value - centre});
    return trials;
}

/// A value in the middle of the sample: sums of the differences from it lose little to rounding, and nothing where all
/// values are equal. NaN for fewer than two values or an infinite one.
double centre_of(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    if (values.size() < 2 || std::any_of(values.begin(), values.end(), [](double x) { return std::isinf(x); }))
        return nan;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

Interval bootstrap_mean_interval(const std::vector<double>& by_trial, std::uint64_t root_seed,
                                 const std::string& column, double alpha) {
    const double centre = centre_of(by_trial);
    if (std::isnan(centre)) return {nan, nan};
    std::vector<BlockPart> blocks;
    if (by_trial.size() >= fewest_blocks * resampled_trials) blocks = blocks_of(by_trial, centre);
    std::vector<double> means = blocks.size() >= fewest_blocks
                                    ? resampled_means(blocks, root_seed, column)
                                    : resampled_means(trials_of(by_trial, centre), root_seed, column);
    return {centre + quantile(means, alpha / 2), centre + quantile(means, 1 - alpha / 2)};
}

}  // namespace credence
