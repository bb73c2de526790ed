// What the verdict says of few runs, by the segments that they are counted in, and of few trials: each table of
// experiments/verdict/runs-*.csv is one argument [docs/theory/statistics.md, One log].
//
//   verdict_runs TABLE [STUDIES [TEXT]]      STUDIES a cell, 60 by default; rows with this text
//
// Errors of n components are autoregressions with variance 1 and P = 1, times what a row says. A share of the variance
// is drawn once a run; a study is R runs of K steps.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <credence/consistency.hpp>
#include <credence/record.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace credence::runs {

namespace {

using Generator = std::mt19937_64;
using Draw = std::function<double(Generator&)>;

double normal(Generator& generator) { return std::normal_distribution<double>()(generator); }
double laplace(Generator& generator) {
    const double u = std::uniform_real_distribution<double>(-1, 1)(generator);
    return std::copysign(std::log1p(-std::abs(u)), u) / std::sqrt(2);
}
double student(Generator& generator, double degrees) {
    return std::student_t_distribution<double>(degrees)(generator) / std::sqrt(degrees / (degrees - 2));
}
double rarely(Generator& generator, double share, double size) {
    const bool is_large = std::uniform_real_distribution<double>()(generator) < share;
    return normal(generator) * (is_large ? size : 1) / std::sqrt(1 + share * (size * size - 1));
}

/// One kind of study.
struct Study {
    int runs = 1, steps = 1000, n = 3;
    double time = 2;          ///< autocorrelation time of the errors, in steps
    double factor = 1;        ///< on P
    double once = 0;          ///< share of the variance that is drawn once a run, of each component
    double first_once = 0;    ///< the same of the first component alone
    double offset = 0;        ///< of the first component, in every run
    double drift = 0;         ///< of the last component, from -drift/2 to drift/2 over each run
    double correlation = 0;   ///< of the first and the last component, of which P knows nothing
    double first_factor = 1;  ///< on the variance in P of the first component
    double known = 0;         ///< correlation of the first two components, which P knows
    Draw draw = normal;
    bool by_trial = false;  ///< one scale a run: `draw` scales its normal errors
    bool of_innovations = false;
};

struct Drawn {
    std::vector<double> errors, P;
};

Drawn drawn(const Study& study, Generator& generator) {
    const int n = study.n;
    const double rho = (study.time - 0.5) / (study.time + 0.5), fresh = std::sqrt(1 - rho * rho);
    Drawn of{{}, std::vector<double>(static_cast<std::size_t>(n * n))};
    Eigen::Map<Eigen::MatrixXd> P(of.P.data(), n, n);
    P.setIdentity();
    if (n > 1) P(0, 1) = P(1, 0) = study.known;
    P.row(0) *= std::sqrt(study.first_factor);
    P.col(0) *= std::sqrt(study.first_factor);
    P *= study.factor;
    std::vector<double> x(static_cast<std::size_t>(n)), fixed(x.size()), e(x.size());
    for (int run = 0; run < study.runs; ++run) {
        const double scale = study.by_trial ? std::abs(study.draw(generator)) : 1;
        const Draw& draw = study.by_trial ? normal : study.draw;
        for (std::size_t j = 0; j < x.size(); ++j) fixed[j] = normal(generator), x[j] = 0;
        for (int k = -static_cast<int>(10 * study.time); k < study.steps; ++k) {
            for (std::size_t j = 0; j < x.size(); ++j) x[j] = rho * x[j] + fresh * draw(generator);
            if (k < 0) continue;
            for (std::size_t j = 0; j < x.size(); ++j) {
                const double once = j == 0 && study.first_once > 0 ? study.first_once : study.once;
                e[j] = scale * (std::sqrt(1 - once) * x[j] + std::sqrt(once) * fixed[j]);
            }
            if (n > 1) e[1] = study.known * e[0] + std::sqrt(1 - study.known * study.known) * e[1];
            double& last = e[x.size() - 1];
            last = study.correlation * e[0] + std::sqrt(1 - study.correlation * study.correlation) * last;
            e[0] += study.offset;
            last += study.drift * (k / std::max(1.0, study.steps - 1.0) - 0.5);
            of.errors.insert(of.errors.end(), e.begin(), e.end());
        }
    }
    return of;
}

struct Outcome {
    Consistency verdict;
    Evidence evidence;
};

Outcome judged(const Study& study, std::uint64_t seed) {
    Generator generator(seed);
    const Drawn drawn_ = drawn(study, generator);
    const std::int64_t n = study.n, steps = study.steps;
    constexpr RecordArray::Type real = RecordArray::Type::real64;
    RecordArrays record;
    const bool alone = study.of_innovations;
    const std::string error = alone ? "innovation" : "error", P = alone ? "innovation_covariance" : "covariance";
    record.arrays = {{error, drawn_.errors.data(), real, {study.runs, steps, n}, {steps * n, n, 1}},
                     {P, drawn_.P.data(), real, {study.runs, steps, n, n}, {0, 0, n, 1}}};
    Outcome outcome;
    outcome.evidence = evidence_of(read_record(record, "study"));
    outcome.verdict = judge(outcome.evidence, Limits());
    return outcome;
}

/// Counts words over the studies of a cell, each with seeds of its own.
class Table {
public:
    Table(int studies, const char* head, const std::string& only) : studies_(studies), only_(only) {
        std::printf("%s\n", head);
    }

    void row(const std::string& name, const Study& study) {
        ++cells_;
        if (name.find(only_) == std::string::npos) return;
        int words[6]{}, large = 0, small = 0, notes = 0;
        double segments = 0;
        for (int i = 0; i < studies_; ++i) {
            const Outcome outcome = judged(study, cells_ << 32 | static_cast<std::uint64_t>(i));
            ++words[static_cast<int>(outcome.verdict.verdict)];
            const Verdict word = outcome.verdict.verdict;
            large += word == Verdict::optimistic || word == Verdict::mixed;
            notes += !outcome.verdict.cautions.empty();
            small += word == Verdict::pessimistic || word == Verdict::mixed;
            segments += outcome.evidence.segments.count ? static_cast<double>(outcome.evidence.segments.run.size()) : 0;
        }
        std::printf("\"%s\",%d,%d,%d,%.0f,%d,%d,%d,%d,%d\n", name.c_str(), study.n, study.runs, study.steps,
                    segments / studies_, studies_, large, small, notes, words[static_cast<int>(Verdict::consistent)]);
        std::fflush(stdout);
    }

private:
    int studies_;
    std::string only_;
    std::uint64_t cells_ = 1;
};

constexpr const char* columns =
    "errors,components,runs,steps,\"segments, mean\",studies,too large,too small,with a note,consistent";

/// The same filter in 1 to 300 runs, about the number at which runs alone used to count.
void print_units(int studies, const std::string& only) {
    Table table(studies, columns, only);
    for (const int runs : {5, 19, 20, 21, 200, 201}) {
        Study study{runs, 600};
        table.row("right", study);
        study.factor = 1.1, table.row("P x 1.1", study);
        study.factor = 0.9, table.row("P x 0.9", study);
        study.factor = 1.25, table.row("P x 1.25", study);
        study.factor = 1, study.correlation = 0.3, table.row("correlation of 0.3 dropped", study);
    }
}

/// Right filters of which something is drawn once a run, or whose steps have heavy tails.
void print_right(int studies, const std::string& only) {
    Table table(studies, columns, only);
    for (const double once : {0.02, 0.05, 0.1, 0.3})
        for (const int runs : {5, 8, 30}) {
            Study study{runs, 600};
            study.once = once, table.row("drawn once: " + std::to_string(once).substr(0, 4), study);
        }
    const std::pair<const char*, Draw> tails[] = {
        {"Laplace", laplace},
        {"t3", [](Generator& g) { return student(g, 3); }},
        {"0.3 % at 8 sigma", [](Generator& g) { return rarely(g, 0.003, 8); }},
        {"1 % at 5 sigma", [](Generator& g) { return rarely(g, 0.01, 5); }}};
    for (const auto& [name, draw] : tails)
        for (const double time : {0.5, 5.0})
            for (const int runs : {5, 20})
                for (const int steps : {60, 200, 600}) {
                    Study study{runs, steps, 2, time};
                    study.draw = draw;
                    table.row(std::string(name) + ", time " + std::to_string(time).substr(0, 3), study);
                }
}

/// What is drawn once in a log.
void print_logs(int studies, const std::string& only) {
    Table table(studies, columns, only);
    for (const int steps : {1000, 3000, 10000})
        for (const double once : {0.0, 0.05, 0.1, 0.2, 0.3, 0.5}) {
            Study study{1, steps};
            study.once = once, table.row("right; drawn once: " + std::to_string(once).substr(0, 4), study);
        }
    for (const int runs : {1, 3, 4}) {
        Study study{runs, 3000};
        study.first_once = 0.28, table.row("right; one component drawn once: 0.28", study);
        study.first_once = 0.5, table.row("right; one component drawn once: 0.5", study);
        study.first_once = 0;
        for (const double factor : {0.8, 0.5}) {
            study.factor = factor;
            const std::string name = "P x " + std::to_string(factor).substr(0, 3);
            study.offset = 0, table.row(name, study);
            study.offset = 1, table.row(name + ", offset of 1 sigma", study);
            study.offset = 0, study.drift = 1.5, table.row(name + ", drift of 1.5 sigma", study);
            study.drift = 4, table.row(name + ", drift of 4 sigma", study), study.drift = 0;
        }
        study.factor = 1;
        study.offset = 5, table.row("offset of 5 sigma", study), study.offset = 0;
        study.drift = 1, table.row("right; drift of 1 sigma", study), study.drift = 0;
    }
    for (const double time : {0.5, 10.0, 25.0})
        for (const int runs : {1, 2, 4}) {
            Study study{runs, 3000, 3, time};
            const std::string name = ", time " + std::to_string(time).substr(0, 4);
            table.row("right" + name, study);
            study.once = 0.1, table.row("right; drawn once: 0.1" + name, study), study.once = 0;
            study.factor = 0.5, table.row("P x 0.5" + name, study);
        }
}

const std::pair<const char*, Draw> heavy[] = {
    {"normal", normal},
    {"Laplace", laplace},
    {"t5", [](Generator& g) { return student(g, 5); }},
    {"t3", [](Generator& g) { return student(g, 3); }},
    {"10 % at 2.7 sigma, the others at 0.5", [](Generator& g) { return rarely(g, 0.1, 6); }},
    {"1 % at 5 sigma", [](Generator& g) { return rarely(g, 0.01, 5); }},
    {"0.3 % at 8 sigma", [](Generator& g) { return rarely(g, 0.003, 8); }}};

/// Short trials, right: what is far off is seen rarely.
void print_short(int studies, const std::string& only) {
    Table table(studies, columns, only);
    for (const auto& [name, draw] : heavy)
        for (const int steps : {1, 3})
            for (const int runs : {20, 50, 100, 199, 1000})
                for (const int n : {1, 3}) {
                    Study study{runs, steps, n, 0.5};
                    study.draw = draw;
                    table.row(name, study);
                }
}

/// One component that is wrong, and few trials of right filters of several components.
void print_components(int studies, const std::string& only) {
    Table table(studies, columns, only);
    for (const int runs : {20, 50, 199}) {
        Study degrees{runs, 10, 2};
        degrees.known = -0.7;
        degrees.first_factor = 57 * 57;
        table.row("one of two in degrees", degrees);
        for (const int n : {3, 6, 15})
            for (const int steps : {3, 10, 100}) {
                Study study{runs, steps, n};
                table.row("right", study);
                study.draw = laplace, table.row("right, Laplace", study), study.draw = normal;
                study.correlation = 0.6, table.row("correlation of 0.6 dropped", study), study.correlation = 0;
                study.first_factor = 0.5, table.row("P of one component x 0.5", study);
            }
    }
}

/// Innovations alone.
void print_innovations(int studies, const std::string& only) {
    Table table(studies, columns, only);
    for (const int steps : {200, 1000})
        for (const auto& [name, draw] : heavy) {
            Study study{1, steps, 2, 0.5};
            study.of_innovations = true;
            study.draw = draw;
            table.row(std::string("white, ") + name, study);
        }
    for (const double lag1 : {0.1, 0.2, 0.3, 0.5}) {
        Study study{1, 1000, 2, 0.5 + lag1 / (1 - lag1)};
        study.of_innovations = true;
        table.row("correlation of " + std::to_string(lag1).substr(0, 3) + " at lag 1", study);
    }
}

}  // namespace

}  // namespace credence::runs

int main(int argument_count, char** arguments) {
    using namespace credence::runs;
    const std::string table = argument_count > 1 ? arguments[1] : "";
    const int studies = argument_count > 2 ? std::atoi(arguments[2]) : 60;
    const std::string only = argument_count > 3 ? arguments[3] : "";
    if (table == "units")
        print_units(studies, only);
    else if (table == "right")
        print_right(studies, only);
    else if (table == "logs")
        print_logs(studies, only);
    else if (table == "short")
        print_short(studies, only);
    else if (table == "components")
        print_components(studies, only);
    else if (table == "innovations")
        print_innovations(studies, only);
    else
        return std::fprintf(stderr, "usage: verdict_runs units|right|logs|short|components|innovations [STUDIES]\n"), 2;
}
