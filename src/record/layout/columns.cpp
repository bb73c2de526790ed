// The columns of a record's own, and the name of its arm.

#include <algorithm>
#include <cmath>
#include <credence/error.hpp>
#include <credence/text.hpp>

#include "base/nan.hpp"
#include "record/layout/parts.hpp"
#include "record/results.hpp"

namespace credence {

namespace {

/// The values of a column. A number that could not be averaged counts as none.
std::vector<double> read_column(const RecordDataset& dataset, std::int64_t trials) {
    std::vector<double> values = read_by_trial(dataset, trials, "Write it as [trial], one number of each",
                                               "Give an array [trial], one number of each");
    std::ranges::replace_if(values, [](double value) { return !(std::abs(value) <= largest_number); }, nan);
    return values;
}

}  // namespace

void add_columns(const RecordSource& source, RecordShape& shape) {
    const auto text = [&](const std::string& name, const std::string& path, const std::string& otherwise) {
        const std::string said = source.has_attribute(name, path) ? printable(source.text(name, path)) : "";
        return said.empty() ? otherwise : said;
    };
    if (source.has_attribute("arm", "") && !source.number("arm")) shape.arm = text("arm", "", "");
    if (shape.arm.empty() || shape.arm.find_first_of("/:, ") != std::string::npos) shape.arm = RecordShape().arm;
    for (const std::string& name : source.names_in("column")) {
        const std::string path = "column/" + name;
        const std::vector<Column> known = record_columns(shape);
        const auto same = std::ranges::find(known, name, &Column::name);
        if (name.empty() || printable(name) != name || (same != known.end() && name != unseen_column))
            throw RecordError(record_place(path), "is no name for a column of one's own, or one that every record has",
                              "Give it another name");
        shape.column_values.push_back(read_column(*source.open(path, Numbers::any), shape.trials));
        shape.columns.push_back({name, text("long_name", path, name), text("units", path, "1"), ColumnType::real, nan});
    }
}

}  // namespace credence
