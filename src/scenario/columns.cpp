#include <credence/columns.hpp>

#include "base/nan.hpp"

#include <algorithm>

namespace credence {

const std::vector<std::string>& status_names() {
    static const auto& names = *new std::vector<std::string>{
        "completed", "diverged", "covariance_not_positive_definite", "non_finite"};
    return names;
}

Column log_score_column() {
    return {"log_score", "mean over the steps of the negative log-likelihood of the truth", "nat", ColumnType::real,
            nan, {.watch = false}};
}

std::vector<Column> status_columns() {
    return {{"status", "how the trial ended", "1", ColumnType::status, 0},
            {"status_pose", "pose at which the status arose, -1 for none", "1", ColumnType::integer, -1}};
}

const std::vector<std::string>& kept_errors_names() {
    static const auto& names = *new std::vector<std::string>{"none", "last", "mean"};
    return names;
}

std::vector<int> kept_steps(KeptErrors kept, int steps) {
    if (kept == KeptErrors::none) return {};
    const int count = kept == KeptErrors::last ? 1 : std::min(steps, most_kept_steps);
    std::vector<int> places;
    for (int i = 1; i <= count; ++i) places.push_back(count == 1 ? steps - 1 : (i - 1) * (steps - 1) / (count - 1));
    return places;
}

std::vector<Column> with_errors(std::vector<Column> columns, const std::vector<Component>& components, int steps,
                                const BudgetSettings& budget) {
    std::vector<Column> kept;
    for (const bool variances : {false, true})
        for (const int step : kept_steps(budget.errors, steps))
            for (const Component& component : components) {
                if (variances && !budget.keeps_variances()) continue;
                const std::string what = variances ? "variance" : "error", at = std::to_string(step + 1),
                                  unit = component.unit + (variances && component.unit != "1" ? "^2" : "");
                kept.push_back({what + "_" + component.name + (budget.errors == KeptErrors::last ? "" : "_" + at),
                                what + " of " + component.name + " at step " + at, unit, ColumnType::real, nan,
                                {false, false, false, false}});
            }
    columns.insert(columns.end() - 2, kept.begin(), kept.end());
    return columns;
}

std::size_t status_column(const std::vector<Column>& columns) {
    const auto found = std::ranges::find(columns, ColumnType::status, &Column::type);
    return static_cast<std::size_t>(found - columns.begin());
}

int detailed_trials(int steps, int state_size) {
    constexpr int most = 4096, numbers = 1 << 24, block = 256;
    const int room = numbers / steps / (state_size + 1) / block * block;
    return std::clamp(room, block, most);
}

bool fill_failed(const std::vector<Column>& columns, double* values) {
    const std::size_t status = status_column(columns);
    if (!failed(static_cast<Status>(static_cast<int>(values[status])))) return false;
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (c != status && c != status + 1) values[c] = columns[c].fill;
    return true;
}

}  // namespace credence
