// What the verdict says where the truth has errors of its own: the tables experiments/verdict/truth.csv and
// truth-logs.csv [docs/theory/statistics.md, Uncertain truth].
//
//   verdict_truth cells|logs [STUDIES]      STUDIES a cell, 24 by default
//
// Errors of three components are autoregressions with P = 1, in runs of K steps. The truth's errors have the variance R
// in each component; the record states their sigma right, or times what a row says.

#include <algorithm>
#include <cmath>
#include <credence/report.hpp>
#include <credence/text.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace credence::truth {

namespace {

using Generator = std::mt19937_64;

double normal(Generator& generator) { return std::normal_distribution<double>()(generator); }

/// Autoregressions of variance 1 [steps, n].
std::vector<double> autoregressive(int steps, int n, double time, Generator& generator) {
    const double rho = (time - 0.5) / (time + 0.5), fresh = std::sqrt(1 - rho * rho);
    std::vector<double> x(static_cast<std::size_t>(steps * n));
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = i < static_cast<std::size_t>(n) ? normal(generator)
                                               : rho * x[i - static_cast<std::size_t>(n)] + fresh * normal(generator);
    return x;
}

constexpr int n = 3;

enum class Structure { white, correlated, constant_in_run, constant, alike };
constexpr const char* structure_names[] = {"white", "correlated over 20 steps", "constant in a run",
                                           "constant over all runs", "alike in all runs by step"};

struct Study {
    int runs = 1, steps = 3000;
    Structure structure = Structure::white;
    double R = 1, stated = 1;  ///< of the truth's errors, and the factor on their sigma that the record states; 0: none
    double P = 1;              ///< that the filter says
    double filter = 1, time = 2;  ///< the variance of the filter's errors, and their autocorrelation time
};

ArmReport judged(const Study& study, std::uint64_t seed) {
    Generator generator(seed);
    const double time = study.structure == Structure::white ? 0.5 : 20;
    const bool constant = study.structure == Structure::constant || study.structure == Structure::constant_in_run,
               once = study.structure == Structure::constant || study.structure == Structure::alike;
    std::vector<double> errors, truth;
    for (int run = 0; run < study.runs; ++run) {
        const std::vector<double> own = autoregressive(study.steps, n, study.time, generator);
        if (run == 0 || !once) truth = autoregressive(constant ? 1 : study.steps, n, time, generator);
        for (std::size_t i = 0; i < own.size(); ++i)
            errors.push_back(std::sqrt(study.filter) * own[i] + std::sqrt(study.R) * truth[i % truth.size()]);
    }
    std::vector<double> P(n * n);
    for (std::size_t j = 0; j < n; ++j) P[j * n + j] = study.P;
    constexpr RecordArray::Type real = RecordArray::Type::real64;
    RecordArrays record;
    record.arrays = {{"error", errors.data(), real, {study.runs, study.steps, n}, {study.steps * n, n, 1}},
                     {"covariance", P.data(), real, {study.runs, study.steps, n, n}, {0, 0, n, 1}}};
    record.texts = {{"component_names", "x,y,z"}, {"component_units", "m,m,m"}};
    if (study.stated > 0) record.texts["truth_sigma"] = to_text(study.stated * std::sqrt(study.R));
    return make_record_report(read_record(record, "study"), "study", Limits()).arms.front();
}

bool is_too_large(const ArmReport& arm) {
    return std::ranges::any_of(arm.consistency.findings,
                               [](const Finding& one) { return one.what != Fault::pessimistic; });
}

void print_cell(const Study& study, double ratio, int studies, std::uint64_t cell) {
    if (study.runs > 100) studies /= 4;
    int large = 0, small = 0, consistent = 0;
    for (int i = 0; i < studies; ++i) {
        const ArmReport arm = judged(study, cell << 32 | static_cast<std::uint64_t>(i));
        large += is_too_large(arm);
        small += std::ranges::any_of(arm.consistency.findings,
                                     [](const Finding& one) { return one.what == Fault::pessimistic; });
        consistent += arm.consistency.verdict == Verdict::consistent;
    }
    std::printf("%s,%g,%g,%g,%d,%d,%d,%d,%d,%d\n", structure_names[static_cast<int>(study.structure)], ratio,
                study.stated, study.P, study.runs, study.steps, studies, large, small, consistent);
    std::fflush(stdout);
}

/// Filters that are right, and ones whose P is 0.5 or 2 times what it should be beside a truth of a tenth of it.
void print_cells(int studies) {
    std::printf("truth's errors,P/R,sigma stated,P over right,runs,steps,studies,too large,too small,consistent\n");
    std::uint64_t cell = 0;
    for (const Structure structure :
         {Structure::white, Structure::correlated, Structure::constant_in_run, Structure::constant, Structure::alike})
        for (const auto& [runs, steps] : {std::pair(50, 20), std::pair(1000, 20), std::pair(1, 3000)}) {
            Study study{runs, steps, structure};
            for (const double ratio : {10.0, 1.0, 0.1}) {
                study.R = 1 / ratio;
                for (const double stated : {0.0, 0.5, 1.0, 2.0}) {
                    study.stated = stated;
                    print_cell(study, ratio, studies, ++cell);
                }
            }
            study.R = 0.1, study.stated = 1;
            for (const double P : {0.5, 2.0}) study.P = P, print_cell(study, 10, studies, ++cell);
        }
}

/// Logs of a filter that says 1 mm, and whose errors are of 1 or 10 mm, beside a reference that is off.
void print_logs() {
    std::printf(
        "errors (mm),reference off (mm),structure,verdict,turning point (mm),P right at (mm),"
        "no finding from (mm),verdict with R,factor on P\n");
    std::uint64_t seed = 0;
    for (const double errors : {1.0, 10.0})
        for (const Structure structure : {Structure::correlated, Structure::constant})
            for (const double off : {0.0, 2.0, 5.0, 10.0, 20.0}) {
                Study study{1, 3000, structure, off * off * 1e-6, 0, 1e-6, errors * errors * 1e-6, 5};
                const ArmReport without = judged(study, ++seed);
                const std::vector<TurningPoint>& points = without.consistency.turning_points;
                std::string turning = ",,";
                if (!points.empty()) {
                    double low = 0, high = 10 * std::max(errors, off) * 1e-3;  // of stated sigmas
                    for (int i = 0; i < 12 && off > 0; ++i) {
                        study.stated = (low + high) / 2 / std::sqrt(study.R);
                        (is_too_large(judged(study, seed)) ? low : high) = (low + high) / 2;
                    }
                    char text[80];
                    std::snprintf(text, sizeof text, "%.2g,%.2g,", 1e3 * points.front().vanishes,
                                  1e3 * points.front().right);
                    turning = text;
                    if (off > 0) std::snprintf(text, sizeof text, "%.2g", 1e3 * high), turning += text;
                }
                std::string with = ",";
                if (off > 0) {
                    study.stated = 1;
                    const Consistency verdict = judged(study, seed).consistency;
                    with = verdict_name(verdict.verdict) + ",";
                    char text[80];
                    if (!verdict.truth.empty()) {
                        const Interval factor = verdict.truth.front().factor;
                        std::snprintf(text, sizeof text, "%.2g to %.2g", factor.low, factor.high);
                        with += text;
                    }
                }
                std::printf("%g,%g,%s,%s,%s,%s\n", errors, off, structure_names[static_cast<int>(structure)],
                            verdict_name(without.consistency.verdict).c_str(), turning.c_str(), with.c_str());
                std::fflush(stdout);
            }
}

}  // namespace

}  // namespace credence::truth

int main(int argument_count, char** arguments) {
    using namespace credence::truth;
    const std::string table = argument_count > 1 ? arguments[1] : "";
    const int studies = argument_count > 2 ? std::atoi(arguments[2]) : 24;
    if (table == "cells")
        print_cells(studies);
    else if (table == "logs")
        print_logs();
    else
        return std::fprintf(stderr, "usage: verdict_truth cells|logs [STUDIES]\n"), 2;
}
