// The operating characteristics of the verdict [docs/theory/statistics.md, Calibration and power]: how often it is
// wrong about a filter that is right, how often it finds what is wrong, and how long a right filter stays undecided.
// Each cell is a number of studies, each of which goes through the code of `credence judge` with its default limits.
//
//   verdict_rates [SHARE]      SHARE of the studies, 1 by default

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <credence/consistency.hpp>
#include <credence/record.hpp>
#include <credence/statistics.hpp>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "filters.hpp"

namespace credence::rates {

namespace {

/// The verdict on one study of a filter.
Consistency judged(const Filter& filter, std::uint64_t seed, int trials) {
    const auto steps = static_cast<std::int64_t>(filter.covariance.size());
    const std::int64_t n = filter.groups.front().count, m = filter.rows;
    std::vector<double> errors, covariances, innovations;
    for (const Eigen::MatrixXd& P : filter.covariance)
        covariances.insert(covariances.end(), P.data(), P.data() + n * n);
    for (std::int64_t i = 0; i < trials; ++i) {
        const Trial trial = filter.trial(Draws(seed, i));
        errors.insert(errors.end(), trial.error.data(), trial.error.data() + steps * n);
        innovations.insert(innovations.end(), trial.innovation.data(), trial.innovation.data() + steps * m);
    }
    const Eigen::MatrixXd S = Eigen::MatrixXd::Identity(m, m);
    constexpr RecordArray::Type real = RecordArray::Type::real64;
    RecordArrays record;
    record.arrays = {{"error", errors.data(), real, {trials, steps, n}, {steps * n, n, 1}},
                     {"covariance", covariances.data(), real, {trials, steps, n, n}, {0, n * n, n, 1}}};
    if (m > 0) {
        record.arrays.push_back({"innovation", innovations.data(), real, {trials, steps, m}, {steps * m, m, 1}});
        record.arrays.push_back({"innovation_covariance", S.data(), real, {trials, steps, m, m}, {0, 0, m, 1}});
    }
    for (std::size_t g = 1; g < filter.groups.size(); ++g) {
        std::vector<std::string> entry{filter.groups[g].name};
        for (int j = 0; j < filter.groups[g].count; ++j) entry.push_back(std::to_string(filter.groups[g].component(j)));
        record.lists["groups"].push_back(entry);
    }
    return judge(evidence_of(read_record(record, "study")), Limits());
}

/// Makes the studies of one cell after the other, each cell with seeds of its own.
class Laboratory {
public:
    explicit Laboratory(double share) : share_(share) {}

    /// How many studies a cell of so many trials gets.
    int studies(int trials) const {
        const int all = trials <= 500 ? 200 : trials <= 2000 ? 120 : 80;
        return std::max(1, static_cast<int>(std::lround(all * share_)));
    }

    std::vector<Consistency> cell(const Filter& filter, int trials) {
        ++cells_;
        std::vector<Consistency> verdicts(static_cast<std::size_t>(studies(trials)));
#pragma omp parallel for schedule(dynamic)
        for (std::size_t study = 0; study < verdicts.size(); ++study)
            verdicts[study] = judged(filter, cells_ << 32 | study, trials);
        return verdicts;
    }

private:
    double share_;
    std::uint64_t cells_ = 0;
};

template <class Condition>
int count(const std::vector<Consistency>& verdicts, const Condition& condition) {
    return static_cast<int>(std::count_if(verdicts.begin(), verdicts.end(), condition));
}

int count(const std::vector<Consistency>& verdicts, Verdict word) {
    return count(verdicts, [&](const Consistency& one) { return one.verdict == word; });
}

bool calls_wrong(const Consistency& one) {
    return one.verdict == Verdict::optimistic || one.verdict == Verdict::pessimistic || one.verdict == Verdict::mixed;
}

bool notes_correlation(const Consistency& one) {
    return std::any_of(one.cautions.begin(), one.cautions.end(),
                       [](const Finding& caution) { return caution.what == Fault::correlated; });
}

/// A share in per cent, and its exact binomial limit, one-sided at 95 %.
enum class Limit { lower, upper };
std::string percent(int count, std::size_t of, Limit limit) {
    using Binomial = boost::math::binomial;
    const auto n = static_cast<double>(of);
    const double bound = limit == Limit::lower ? Binomial::find_lower_bound_on_p(n, count, 0.05)
                                               : Binomial::find_upper_bound_on_p(n, count, 0.05);
    char text[40];
    const char* sign = limit == Limit::lower ? "≥" : "≤";
    std::snprintf(text, sizeof text, " %.3g (%s %.3g) |", 100 * count / n, sign, 100 * bound);
    return text;
}

std::string title(const Path& path) {
    char text[80];
    std::snprintf(text, sizeof text, "n = %d, K = %d, correlation %.1f", path.n, path.steps, path.correlation);
    return text;
}

void print_head(const std::vector<std::string>& columns) {
    std::string names = "|", rule = "|";
    for (const std::string& column : columns) {
        names += " " + column + " |";
        rule += "---|";
    }
    std::printf("%s\n%s\n", names.c_str(), rule.c_str());
}

/// Rows end as soon as they are known.
void print_row(const std::string& row) {
    std::printf("| %s\n", row.c_str());
    std::fflush(stdout);
}

/// How often a right filter is called wrong.
void print_false_verdicts(Laboratory& laboratory, Path path) {
    const int sizes[] = {20, 50, 100, 200, 500, 2000, 5000};
    const std::pair<Tails, const char*> distributions[] = {
        {Tails::normal, "normal"},
        {Tails::t5_trial, "t₅, one scale a trial"},
        {Tails::t5_step, "t₅, a step"},
        {Tails::t5_component, "t₅, a component and step"},
        {Tails::t5_component_trial, "t₅, a component and trial"},
        {Tails::laplace, "Laplace"},
        {Tails::contaminated_steps, "5 % of steps at 3 σ"},
        {Tails::contaminated_trials, "5 % of trials at 3 σ"},
        {Tails::outlying_steps, "1 % of steps at 5 σ"},
        {Tails::rarely_diverged, "0.3 % of trials at 8 σ, the others right"},
        {Tails::diverged, "1 % of trials at 10 σ, the others right"}};
    std::printf("\nFalse verdicts on a right filter, per cent; %s\n\n", title(path).c_str());
    std::vector<std::string> columns{"errors"};
    for (const int trials : sizes) columns.push_back("N = " + std::to_string(trials));
    columns.push_back("optimistic, pessimistic, mixed");
    print_head(columns);
    for (const auto& [tails, name] : distributions) {
        path.tails = tails;
        std::string row = std::string(name) + " |";
        int optimistic = 0, pessimistic = 0, mixed = 0;
        for (const int trials : sizes) {
            const std::vector<Consistency> verdicts = laboratory.cell(right(path), trials);
            row += percent(count(verdicts, calls_wrong), verdicts.size(), Limit::upper);
            optimistic += count(verdicts, Verdict::optimistic);
            pessimistic += count(verdicts, Verdict::pessimistic);
            mixed += count(verdicts, Verdict::mixed);
        }
        print_row(row + " " + std::to_string(optimistic) + ", " + std::to_string(pessimistic) + ", " +
                  std::to_string(mixed) + " |");
    }
}

const int power_sizes[] = {30, 200, 1000, 4000};

/// How often something is found: the share of studies for which `found` holds, at several sizes.
template <class Condition>
void print_power(Laboratory& laboratory, const std::string& name, const Filter& filter, const Condition& found,
                 Limit limit = Limit::lower) {
    std::string row = name + " |";
    for (const int trials : power_sizes) {
        const std::vector<Consistency> verdicts = laboratory.cell(filter, trials);
        row += percent(count(verdicts, found), verdicts.size(), limit);
    }
    print_row(row);
}

void print_power(Laboratory& laboratory) {
    const auto optimistic = [](const Consistency& one) { return one.verdict == Verdict::optimistic; };
    const auto pessimistic = [](const Consistency& one) { return one.verdict == Verdict::pessimistic; };
    const auto add = [&](const std::string& name, const Filter& filter, const auto& found) {
        print_power(laboratory, name, filter, found);
    };
    const Path four;
    const Path six{6};
    std::printf("\nWhat is wrong and found, per cent; normal errors, %s unless said\n\n", title(four).c_str());
    std::vector<std::string> columns{"what is wrong", "counted"};
    for (const int trials : power_sizes) columns.push_back("N = " + std::to_string(trials));
    print_head(columns);
    add("P × 0.9 | optimistic", scaled(four, 0.9), optimistic);
    add("P × 1.1 | pessimistic", scaled(four, 1.1), pessimistic);
    add("P × 1.25 | pessimistic", scaled(four, 1.25), pessimistic);
    add("P × 2 | pessimistic", scaled(four, 2), pessimistic);
    add("P × 0.5 | optimistic", scaled(four, 0.5), optimistic);
    for (const char* correlation : {"0.2", "0.5"})
        for (const int n : {2, 4, 9})
            add("correlation of " + std::string(correlation) + " dropped, n = " + std::to_string(n) + " | any finding",
                dropped({n}, std::atof(correlation)), calls_wrong);
    add("one group, P × 0.8 | optimistic", wrong_group(four, 0.8), optimistic);
    add("one direction, variance × 2, n = 6 | optimistic", wrong_direction(six, 2), optimistic);
    add("bias of 0.3 σ | optimistic", biased(four, 0.3), optimistic);
    add("tracker, P × 0.9 | optimistic", tracker({0.9}), optimistic);
    add("tracker, P of the position × 0.8 | optimistic", tracker({1, 0.8}), optimistic);
    add("tracker, bias of 0.3 σ | optimistic", tracker({1, 1, 0.3}), optimistic);
    add("innovations with correlation 0.5 | note `correlated`", with_innovations(four, 0.5), notes_correlation);
    add("innovations with correlation 0.1 | note `correlated`", with_innovations(four, 0.1), notes_correlation);
    print_power(laboratory, "innovations that are white | note `correlated`", with_innovations(four, 0),
                notes_correlation, Limit::upper);
}

/// The advised numbers of the studies that have advice.
std::vector<double> advised(const std::vector<Consistency>& verdicts) {
    std::vector<double> numbers;
    for (const Consistency& one : verdicts)
        if (one.trials_needed.value > 0) numbers.push_back(one.trials_needed.value);
    return numbers;
}

/// The median, and between which numbers nine of ten lie.
std::string spread(std::vector<double> numbers) {
    if (numbers.empty()) return " none |";
    char text[80];
    std::snprintf(text, sizeof text, " %.0f (%.0f to %.0f) |", quantile(numbers, 0.5), quantile(numbers, 0.05),
                  quantile(numbers, 0.95));
    return text;
}

void print_undecided(Laboratory& laboratory, const std::string& name, const Filter& filter) {
    std::string row = name + " |";
    for (const int trials : {500, 1000, 2000, 4000}) {
        const std::vector<Consistency> verdicts = laboratory.cell(filter, trials);
        row += percent(count(verdicts, Verdict::consistent), verdicts.size(), Limit::lower);
    }
    row += spread(advised(laboratory.cell(filter, 100)));
    std::vector<double> later = advised(laboratory.cell(filter, 200));
    row += spread(later);
    if (later.empty()) return print_row(row + " |");
    const std::vector<Consistency> there = laboratory.cell(filter, static_cast<int>(std::ceil(quantile(later, 0.5))));
    print_row(row + percent(count(there, Verdict::consistent), there.size(), Limit::lower));
}

/// How long a right filter stays undecided.
void print_undecided(Laboratory& laboratory) {
    std::printf("\nRight filters that are shown `consistent`, per cent; normal errors\n\n");
    print_head({"filter", "N = 500", "N = 1000", "N = 2000", "N = 4000", "advice of 100 trials: median (5 to 95 %)",
                "advice of 200", "`consistent` at that median"});
    for (const Path& path : {Path{2}, Path{4}, Path{9}, Path{4, 10, 0}, Path{4, 50, 0.5}})
        print_undecided(laboratory, title(path), right(path));
    print_undecided(laboratory, "tracker", tracker({}));
}

}  // namespace

}  // namespace credence::rates

int main(int argument_count, char** arguments) {
    using namespace credence::rates;
    Laboratory laboratory(argument_count > 1 ? std::atof(arguments[1]) : 1);
    print_false_verdicts(laboratory, {4, 10, 0.8});
    print_false_verdicts(laboratory, {2, 20, 0.3});
    print_power(laboratory);
    print_undecided(laboratory);
}
