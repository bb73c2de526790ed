#pragma once
// The workspace of trials in the world `explore` that are run one by one.

#include "worlds/explore/trial.hpp"

#include <memory>
#include <vector>

namespace credence {
inline namespace CREDENCE_TARGET {

/// A workspace with the memory that its pointers lead to.
template <class Estimating>
class SingleWorkspace : public ExploreWorkspace<double, Estimating> {
public:
    explicit SingleWorkspace(const ExploreView& view)
        : viewed_(std::make_unique<bool[]>(cells(view) * steps(view))), queue_(cells(view)), from_(cells(view)),
          ahead_(steps(view)) {
        this->viewed = viewed_.get();
        this->queue = queue_.data();
        this->from = from_.data();
        this->ahead = ahead_.data();
    }

private:
    static std::size_t cells(const ExploreView& view) { return static_cast<std::size_t>(view.grid.count()); }
    static std::size_t steps(const ExploreView& view) { return static_cast<std::size_t>(view.control.horizon); }

    std::unique_ptr<bool[]> viewed_;
    std::vector<int> queue_, from_;
    std::vector<Belief<double, ExploreLayout::capacity>> ahead_;
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
