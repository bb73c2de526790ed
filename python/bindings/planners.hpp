#pragma once
// Planners that are functions of Python, for the time of a call.

#include <nanobind/nanobind.h>

#include <credence/detail/planner_batch.hpp>

#include <memory>
#include <string>
#include <vector>

namespace credence::python {

/// Its planners are those of the library while an object exists. It is made and destroyed with Python's lock.
class Planners {
public:
    /// `given`: the name of each, its version, and what is called with a batch.
    explicit Planners(const nanobind::dict& given);

    /// While this exists, which needs no lock.
    class Added {
    public:
        explicit Added(const Planners& planners);
        ~Added();
        Added(const Added&) = delete;
        Added& operator=(const Added&) = delete;

    private:
        const Planners& planners_;
    };

private:
    struct Named {
        std::string name, version;
        std::shared_ptr<const Planner> planner;
    };
    std::vector<Named> all_;
};

void bind_planners(nanobind::module_& module);

}  // namespace credence::python
