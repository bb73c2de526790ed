// The verdict on a record of innovations alone: whether they are correlated.

#include "statistics/whiteness.hpp"
#include "verdict/judgement.hpp"

namespace credence {

void judge_innovations(const Evidence& evidence, Judgement& judgement) {
    if (!evidence.of_innovations) return;
    if (const std::optional<Finding> found = correlation_found(evidence, judgement.limits().margin))
        judgement.add_correlation(*found);
}

}  // namespace credence
