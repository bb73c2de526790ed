// The budget of arrays.

#include "calls.hpp"
#include "judge.hpp"

#include "report/budget.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace credence::python {

namespace {

using Errors = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;  ///< [trial, step, n]

Said budget(const std::vector<Errors>& runs, const std::vector<std::string>& sources,
            const std::vector<std::pair<std::string, std::string>>& components,
            const std::vector<std::pair<std::string, std::vector<int>>>& groups, const std::vector<double>& variance,
            std::int64_t left_out, std::uint64_t seed, const std::string& at, const std::string& of,
            const std::vector<std::pair<std::string, std::vector<double>>>& counted) {
    BudgetErrors errors;
    errors.sources = sources;
    errors.trials = runs.front().shape(0);
    errors.steps = runs.front().shape(1);
    errors.variance = variance;
    for (const auto& [name, unit] : components) errors.components.push_back({name, unit});
    for (const auto& [name, members] : groups)
        errors.groups.push_back({name, members.front(), static_cast<int>(members.size()), members});
    errors.of = [&](std::size_t run, std::size_t component) {
        std::vector<double> values(errors.trials * errors.steps);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = runs[run].data()[i * errors.components.size() + component];
        return values;
    };
    for (const auto& [source, variances] : counted) {
        errors.counted.push_back(source);
        errors.counted_variance.push_back(variances);
    }
    if (!of.empty()) check_part(errors.components, errors.groups, of);
    return alone([&] {
        const auto trials = static_cast<std::int64_t>(errors.trials);
        ArmBudget arm{"", "run", at == "mean" ? KeptErrors::mean : KeptErrors::last, trials, left_out,
                      counted.empty() ? 0 : trials, sources, budget_parts(errors)};
        return Said{[report = BudgetReport{{std::move(arm)}, seed, of}](const std::string& format) {
            return budget_in(report, format);
        }};
    });
}

}  // namespace

void bind_budget(nb::module_& module) {
    module.def("budget", budget, nb::arg("errors"), nb::arg("sources"), nb::arg("components"), nb::arg("groups"),
               nb::arg("variance"), nb::arg("left_out"), nb::arg("seed"), nb::arg("at"), nb::arg("of"),
               nb::arg("counted"));
}

}  // namespace credence::python
