#include "planners.hpp"

#include <credence/error.hpp>

#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace credence::python {

namespace nb = nanobind;

namespace {

/// A new array of NumPy's with a copy of the numbers.
template <class Number>
nb::ndarray<nb::numpy, Number> copied(const Number* from, std::initializer_list<std::size_t> shape) {
    std::size_t count = 1;
    for (const std::size_t size : shape) count *= size;
    auto* numbers = new Number[count];
    if (count > 0) std::memcpy(numbers, from, count * sizeof(Number));
    const nb::capsule owner(numbers, [](void* memory) noexcept { delete[] static_cast<Number*>(memory); });
    return nb::ndarray<nb::numpy, Number>(numbers, shape.size(), shape.begin(), owner);
}

/// A batch as Python sees it, until the planner has answered.
struct Told {
    const PlannerBatch* batch = nullptr;

    const PlannerBatch& operator*() const {
        if (batch == nullptr) throw InputError("now: the step is over. Copy what is to be kept.");
        return *batch;
    }
    std::size_t size(int count) const { return static_cast<std::size_t>(count); }
};

/// [B, C] of every number, in the order trace, log det, new cells, allowed.
nb::list prospects(const Told& told) {
    const PlannerBatch& batch = *told;
    const std::size_t B = told.size(batch.trials), C = told.size(batch.candidates);
    struct Table : ProspectVisitor {
        std::size_t candidates;
        std::vector<double> of[4];
        void visit(int place, int candidate, bool allowed, const Prospect& then) override {
            const std::size_t at = static_cast<std::size_t>(place) * candidates + static_cast<std::size_t>(candidate);
            of[0][at] = then.trace;
            of[1][at] = then.log_det;
            of[2][at] = then.new_cells;
            of[3][at] = allowed;
        }
    } table;
    table.candidates = C;
    for (auto& one : table.of) one.resize(B * C);
    {
        const nb::gil_scoped_release released;
        batch.visit_prospects(table);
    }
    nb::list all;
    for (const auto& one : table.of) all.append(copied(one.data(), {B, C}));
    return all;
}

class PythonPlanner : public Planner {
public:
    PythonPlanner(std::string name, nb::callable ask) : name_(std::move(name)), ask_(std::move(ask)) {}

    void choose(const PlannerBatch& batch) const override {
        std::string trouble;
        {
            const nb::gil_scoped_acquire held;
            const nb::object told = nb::cast(Told{&batch});  // Python may keep it
            try {
                const nb::object answer = ask_(told);
                if (nb::isinstance<nb::str>(answer)) {
                    trouble = nb::cast<std::string>(answer);
                } else {
                    const auto controls = nb::cast<nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig>>(answer);
                    for (std::size_t b = 0; b < controls.shape(0); ++b) {
                        const double* of = controls.data() + 3 * b;
                        batch.control[b] = {of[0], {of[1], of[2]}};
                    }
                }
            } catch (const std::exception& error) {  // python_error, too, which must end before the lock is given back
                trouble = "planner " + name_ + ": " + error.what();
            }
            nb::cast<Told&>(told).batch = nullptr;
        }
        if (!trouble.empty()) throw InputError(trouble);
    }

private:
    std::string name_;
    nb::callable ask_;
};

}  // namespace

Planners::Planners(const nb::dict& given) {
    for (const auto& [name, planner] : given) {
        const auto [version, ask] = nb::cast<std::pair<std::string, nb::callable>>(planner);
        const std::string text = nb::cast<std::string>(name);
        all_.push_back({text, version, std::make_shared<const PythonPlanner>(text, ask)});
    }
}

Planners::Added::Added(const Planners& planners) : planners_(planners) {
    for (const auto& [name, version, planner] : planners.all_) add_planner(name, planner, version);
}

Planners::Added::~Added() {
    for (const auto& named : planners_.all_) remove_planner(named.name);
}

void bind_planners(nb::module_& module) {
    nb::class_<Told>(module, "Told")
        .def_prop_ro("step", [](const Told& told) { return (*told).step; })
        .def_prop_ro("reach", [](const Told& told) { return (*told).reach; })
        .def("trial", [](const Told& told) { return copied((*told).trial, {told.size((*told).trials)}); })
        .def("mean",
             [](const Told& told) {
                 return copied((*told).mean, {told.size((*told).trials), told.size((*told).components)});
             })
        .def("covariance",
             [](const Told& told) {
                 const std::size_t n = told.size((*told).components);
                 return copied((*told).covariance, {told.size((*told).trials), n, n});
             })
        .def("known",
             [](const Told& told) {
                 return copied((*told).known, {told.size((*told).trials), told.size((*told).features)});
             })
        .def("cells",
             [](const Told& told) {
                 const PlannerBatch& batch = *told;
                 return copied(batch.viewed, {told.size(batch.trials), told.size(batch.cell_rows),
                                              told.size(batch.cell_columns)});
             })
        .def("candidates",
             [](const Told& told) {
                 std::vector<double> numbers;
                 for (int i = 0; i < (*told).candidates; ++i) {
                     const Control& one = (*told).candidate[i];
                     numbers.insert(numbers.end(), {one.turn, one.move.x, one.move.y});
                 }
                 return copied(numbers.data(), {numbers.size() / 3, 3});
             })
        .def("uniform",
             [](const Told& told, int count) {
                 std::vector<double> numbers;
                 for (int b = 0; b < (*told).trials; ++b)
                     for (int i = 0; i < count; ++i) numbers.push_back((*told).uniform(b, i));
                 return copied(numbers.data(), {told.size((*told).trials), told.size(count)});
             })
        .def("prospects", prospects);
}

}  // namespace credence::python
