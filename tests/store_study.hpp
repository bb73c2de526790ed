#pragma once
// Small studies, folders and damaged files for the tests of the store.

#include "numeric/chi_square.hpp"
#include <credence/error.hpp>
#include <credence/ini.hpp>
#include <credence/detail/store.hpp>

#include "of_scenarios.hpp"

#include "catch.hpp"
#include "temporary_folder.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace credence::test {

inline std::string bytes_of(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void put_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// What a call says when it refuses; empty where it does not.
template <class Problem, class Call>
std::string refusal(Call call) {
    try {
        call();
    } catch (const Problem& problem) {
        return problem.what();
    }
    return {};
}

inline DeformableSettings scenario(const std::string& name, const std::string& process = "heading") {
    return read_deformable_text("[scenario]\nname = " + name + "\ntitle = größer als 1\nposes = 4\n" +
                                  "[model]\nprocess = " + process, name, name);
}

/// Sums that need one, two and more parts, are negative, or are not finite.
inline ExactSum awkward_sum(std::size_t i) {
    switch (i % 5) {
        case 0: return ExactSum::from_parts({0.1 * static_cast<double>(i)});
        case 1: return ExactSum::from_parts({1e16, 1, 1e-10});
        case 2: return ExactSum::from_parts({-1.0 / 3, 1e-30});
        case 3: return ExactSum::from_parts({1e200, -1, 1e-200, 3});
        default: return i == 4 ? ExactSum::from_parts({NAN}) : ExactSum();
    }
}

/// A study of made-up numbers: 5 trials, of which trial 1 failed and trial 3 diverged.
inline Study made_up_study(const std::vector<DeformableSettings>& scenarios = {scenario("first"),
                                                                               scenario("second", "translation")}) {
    Study study = new_study(scenarios, 18446744073709551615u);
    study.trials = 5;
    study.complete = true;
    for (ScenarioResults& results : study.scenarios) {
        extend(results, 5);
        for (ArmResults& arm : results.arms) {
            std::vector<std::vector<double>>& columns = arm.columns.in_memory();
            for (std::size_t c = 0; c < results.columns.size(); ++c)
                for (std::size_t i = 0; i < 5; ++i) {
                    const bool real = results.columns[c].type == ColumnType::real;
                    columns[c][i] = real ? std::sqrt(static_cast<double>(7 * c + i)) : static_cast<double>(c + i);
                }
            columns[column_status] = {0, 2, 0, 1, 0};
            columns[column_trace_P][1] = -NAN;
            columns[column_unseen][1] = -1;
            std::size_t next = 0;
            for (std::size_t f = 0; f < results.all_series.size(); ++f) {
                const bool integer = results.all_series[f].integer;
                for (ExactSum& sum : arm.totals.series[f].sum) {
                    sum = integer ? ExactSum::from_parts({0x1p60, 1, -static_cast<double>(next)}) : awkward_sum(next);
                    ++next;
                }
                for (ExactSum& sum : arm.totals.series[f].square_sum) sum = awkward_sum(next++);
                arm.totals.series[f].run_square_sum = awkward_sum(next++);
                for (std::size_t i = 0; i < arm.totals.series[f].covered.size(); ++i)
                    arm.totals.series[f].covered[i] = static_cast<std::int64_t>(std::min<std::size_t>(1 + i % 4, 3));
            }
            for (std::size_t k = 0; k < static_cast<std::size_t>(results.steps()); ++k)
                arm.totals.cells[k * distribution_cells + 17 * k] = 3;
            for (std::size_t lag = 0; lag < arm.totals.products.sum.size(); ++lag) {
                arm.totals.products.sum[lag] = awkward_sum(next++);
                arm.totals.products.square_sum[lag] = awkward_sum(next++);
                arm.totals.products.count[lag] = static_cast<std::int64_t>(lag) << 40;
            }
            for (std::size_t i = 0; i < arm.errors.size(); ++i)
                arm.errors[i] = i % 7 == 3 ? -NAN : 0.25 * static_cast<double>(i);
            for (std::size_t i = 0; i < arm.nees.size(); ++i)
                arm.nees[i] = i % 5 == 2 ? NAN : 0.125 * static_cast<double>(i);
        }
        recount(results);
        for (ArmResults& arm : results.arms) {
            arm.totals.diverged = arm.totals.series;
            for (SeriesTotals& of_one : arm.totals.diverged)
                for (std::int64_t& covered : of_one.covered) covered = std::min<std::int64_t>(covered, 1);
        }
    }
    return study;
}

inline const RunFacts run_facts{{"zebra", "first in order"}, {"compiler", "g++ ü"}, {"empty", ""}};

}  // namespace credence::test
