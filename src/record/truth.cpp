// The evidence with the covariance R of the truth's own errors [docs/statistics.md, Uncertain truth].

#include <algorithm>
#include <cmath>

#include "numeric/decompositions.hpp"
#include "record/presence.hpp"
#include "record/read.hpp"

namespace credence {

namespace {

struct Mean {
    double sum = 0, count = 0, largest = 0;

    void add(double value) {
        sum += value;
        ++count;
        largest = std::max(largest, value);
    }
    double value() const { return sum / count; }
};

/// Over the steps of the trials that count, by P + R.
struct TruthSums {
    std::vector<Mean> errors;      ///< [steps, n]
    std::vector<Mean> shares;      ///< [groups] tr((P + R)^-1 R)/d
    std::vector<Mean> deviations;  ///< [n] sqrt(R_jj/(P + R)_jj)

    void add(const RecordShape& shape, int k, const CheckedStep& step) {
        for (std::size_t j = 0; j < step.here.size(); ++j)
            if (step.here[j])
                errors[static_cast<std::size_t>(k) * step.here.size() + j].add(step.e(static_cast<Eigen::Index>(j)));
        for (std::size_t b = 0; b < shape.groups.size(); ++b) {
            std::vector<int> members = members_of(shape.groups[b]);
            std::erase_if(members, [&](int j) { return !step.here[static_cast<std::size_t>(j)]; });
            if (shape.source(b) == GroupSource::nothing || (b > 0 && !step.whole(shape.groups[b]))) continue;
            const bool of_its_own = shape.source(b) == GroupSource::own;
            const Eigen::MatrixXd R = step.R(members, members),
                                  sum = of_its_own ? step.own[b] : covariance_of(step, members);
            const CholeskyFactor factor(sum);
            shares[b].add(factor.solve_lower(factor.solve_lower(R).transpose()).trace() /
                          static_cast<double>(members.size()));
            for (Eigen::Index i = 0; i < R.cols(); ++i)
                deviations[static_cast<std::size_t>(members[static_cast<std::size_t>(i)])].add(
                    std::sqrt(R(i, i) / sum(i, i)));
        }
    }
};

TruthSums sums_of(const RecordReader& reader, const ScenarioResults& added) {
    const RecordShape& shape = reader.shape();
    const auto n = static_cast<std::size_t>(shape.n);
    const std::vector<double>& statuses = added.arms.front().columns.in_memory()[status_column(added.columns)];
    TruthSums sums{std::vector<Mean>(static_cast<std::size_t>(shape.steps) * n), std::vector<Mean>(shape.groups.size()),
                   std::vector<Mean>(n)};
    each_present_step(reader, [&](const RecordStep& step, const CheckedStep& checked) {
        if (counts(static_cast<Status>(static_cast<int>(statuses[static_cast<std::size_t>(step.trial)]))))
            sums.add(shape, step.step, checked);
    });
    return sums;
}

}  // namespace

/// Errors about the mean of N trials have the variance 1 - 1/N, for which the factor makes up.
std::shared_ptr<const TruthEvidence> truth_evidence(RecordReader& reader, const std::string& name, int segments) {
    auto evidence = std::make_shared<TruthEvidence>();
    if (reader.shape().truth_depends) {
        reader.use_truth(TruthUse::subtracted);
        evidence->subtracted = evidence_of(read_record(reader, name, {}, segments));
    }
    reader.use_truth(TruthUse::added);
    const Record added = read_record(reader, name, {}, segments);
    evidence->added = evidence_of(added);
    const TruthSums sums = sums_of(reader, added.results);
    for (const Mean& share : sums.shares) evidence->shares.push_back(share.value());
    for (std::size_t j = 0; j < evidence->added.bias.size(); ++j) {
        evidence->added.bias[j].truth = sums.deviations[j].value();
        evidence->added.bias[j].largest_truth = sums.deviations[j].largest;
    }
    if (evidence->added.trials < runs_that_tell) return evidence;
    std::vector<double> means, factors;
    for (const Mean& mean : sums.errors) {
        means.push_back(mean.count > 0 ? mean.value() : 0);
        factors.push_back(mean.count > 1 ? std::sqrt(mean.count / (mean.count - 1)) : 0);
    }
    reader.centre(std::move(means), std::move(factors));
    evidence->centred = evidence_of(read_record(reader, name, {}, segments));
    return evidence;
}

}  // namespace credence
