#pragma once
// Studies and columns for the tests of `compare`.

#include "report/compare/compare.hpp"
#include "worlds/deformable/keys.hpp"
#include <numeric>

#include "either_way.hpp"
#include "matched.hpp"
#include "of_scenarios.hpp"

namespace credence::test {

inline Study run(const std::vector<DeformableSettings>& scenarios, std::uint64_t seed, std::int64_t trials) {
    Study study = new_study(scenarios, seed);
    run_study(study, {trials, 1, {}});
    return study;
}

inline DeformableSettings changed(DeformableSettings scenario, const std::string& key, const std::string& value) {
    set_key(scenario, key, value);
    return resolved(scenario);
}

/// The matched linear world under both controllers.
inline DeformableSettings matched() {
    DeformableSettings s = matched_linear();
    s.name = "matched";
    s.arms = DeformableSettings{}.arms;
    return resolved(s);
}

inline CompareReport compared(const std::vector<StudyFile>& files, const std::string& arms = "") {
    std::vector<std::string> paths;
    for (const StudyFile& file : files) paths.push_back(file.path);
    const auto compare = [&](const std::vector<StudyFile>& either) {
        return compare_studies(either, arms.empty() ? std::nullopt : std::optional(read_arms(arms, paths)));
    };
    if (files.front().study.trials == 0) return compare(files);  // of names alone
    std::vector<StudyFile> read = files;
    for (StudyFile& file : read) file.study = read_back(file.study);
    const CompareReport in_memory = compare(files), of_files = compare(read);
    CHECK(renderings(of_files) == renderings(in_memory));
    return of_files;
}

inline const PairedComparison& of(const ComparedPair& pair, int column) {
    return pair.comparison.columns[static_cast<std::size_t>(column)].paired;
}

inline double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

inline double variance_of(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return squares / static_cast<double>(values.size() - 1);
}

}  // namespace credence::test
