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
