// The verdict with the covariance R of the truth's own errors, whose structure in time is not known
// [docs/statistics.md, Uncertain truth].

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/nan.hpp"
#include "verdict/judgement.hpp"

namespace credence {

namespace {

/// Copies the findings of this kind, and what is suspected, from one verdict to another. Whether there are findings.
bool take(const Consistency& from, Fault what, const std::string& by, Consistency& to) {
    const std::size_t before = to.findings.size();
    for (const Finding& finding : from.findings)
        if (finding.what == what) to.findings.emplace_back(finding).when += by;
    std::ranges::copy_if(from.suspicions, std::back_inserter(to.suspicions),
                         [&](const Suspicion& one) { return one.what == what; });
    return to.findings.size() > before;
}

/// By P + R errors about their mean are counted, by P they are as they are.
std::vector<TruthFactor> factors_of(const Evidence& evidence, const Limits& limits) {
    const TruthEvidence& truth = *evidence.truth;
    std::vector<TruthFactor> factors;
    for (std::size_t g = 0; g < evidence.groups.size(); ++g) {
        const GroupEvidence& sum = (truth.centred ? *truth.centred : truth.added).groups[g];
        const Moments& nees = sum.centred.count > 0 ? sum.centred : sum.run;
        const Interval nees95 = t_interval(nees);
        const double share = truth.shares[g], lowest = 1 + (nees95.low - 1) / (1 - share),
                     highest = over_steps95(evidence.groups[g]).high,
                     deciding = std::sqrt(limits.margin / 2 * (1 - share) / share);
        if (std::isfinite(lowest) && std::isfinite(highest))
            factors.push_back({evidence.groups[g].name, nees.mean, nees95, {std::max(0.0, lowest), highest}, deciding});
    }
    return factors;
}

}  // namespace

Consistency judge_with_truth(const Evidence& evidence, const Limits& limits) {
    const TruthEvidence& truth = *evidence.truth;
    const Consistency alone = judge_survivors(evidence, limits), sum = judge_survivors(truth.added, limits),
                      about = truth.centred ? judge_survivors(*truth.centred, limits) : sum,
                      less = truth.subtracted ? judge_survivors(*truth.subtracted, limits) : alone;
    const bool is_covariance = !truth.subtracted || truth.subtracted->left_out <= evidence.left_out;
    Consistency verdict;
    verdict.limits = limits;
    verdict.directions = alone.directions;
    verdict.truth = factors_of(evidence, limits);
    const bool large = take(about, Fault::optimistic, ", by P + R", verdict),
               above = take(sum, Fault::biased, ", by P + R", verdict) || large,
               below = is_covariance && take(less, Fault::pessimistic, truth.subtracted ? ", by P - R" : "", verdict);
    std::ranges::copy_if(alone.cautions, std::back_inserter(verdict.cautions), [&](const Finding& one) {
        return one.about == Subject::innovations || std::ranges::any_of(sum.cautions, [&](const Finding& other) {
                   return one.about == other.about && one.where == other.where && one.what == other.what;
               });
    });
    for (double Reached::*margin : {&Reached::nees, &Reached::direction, &Reached::bias})
        verdict.reached.*margin =
            std::isnan(sum.reached.*margin) ? nan : std::max(alone.reached.*margin, sum.reached.*margin);
    verdict.hints = above ? about.hints : below ? less.hints : std::vector<std::string>();
    if (above || below)
        verdict.verdict = above && below ? Verdict::mixed : above ? Verdict::optimistic : Verdict::pessimistic;
    else if (alone.verdict == Verdict::consistent && sum.verdict == Verdict::consistent)
        verdict.verdict = Verdict::consistent;
    if (verdict.verdict != Verdict::undecided) {
        verdict.suspicions.clear();
        return verdict;
    }
    if (!is_covariance)
        verdict.reasons.push_back("P - R is no covariance, so that nothing can be shown to be too small");
    if (alone.verdict != Verdict::undecided) verdict.reasons.push_back("the truth is not accurate enough to tell");
    std::ranges::copy(alone.reasons, std::back_inserter(verdict.reasons));
    if (sum.verdict == Verdict::undecided) verdict.trials_needed = alone.trials_needed;
    return verdict;
}

}  // namespace credence
