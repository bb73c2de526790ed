// Reading a run's columns and totals from its journal.

#include "files/journal/journal.hpp"

#include <credence/error.hpp>

#include <algorithm>

namespace credence {

/// Makes the study read its columns, if trials are kept, and totals that are not in memory: their values are in the
/// journal, in the results file that it extends, or in both.
void Journal::keep(Study& study) {
    kept_.clear();
    computed_by_ = study.computed_by;
    for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
        ScenarioResults& results = study.scenarios[s];
        Kept kept{
            BlockLayout(results), kept_types(results), {}, results.kept_totals, {}, results.trials, {}, {}, {}, {}};
        kept.placed = places_in_file(results, kept.layout);
        results.kept_totals = std::make_shared<KeptTotals>(
            [this, s](ScenarioResults& loaded) { load_totals(s, loaded); });
        for (std::size_t a = 0; a < results.arms.size() && results.keep == Keep::trials; ++a) {
            kept.in_file.push_back(results.arms[a].columns.kept());
            results.arms[a].columns.keep(std::make_shared<KeptColumns>(
                [this, s, a](std::size_t column, std::int64_t first, std::int64_t count) {
                    return values(s, a, column, first, count);
                }));
        }
        kept_.push_back(std::move(kept));
    }
}

void Journal::read_values(std::int64_t position, ColumnType type, double* values, std::int64_t count) const {
    std::string bytes(static_cast<std::size_t>(count * value_size(type)), '\0');
    file_.read(position, bytes.data(), bytes.size());
    ByteReader from(bytes.data(), bytes.size());
    try {
        get_values(from, type, values, static_cast<std::size_t>(count));
    } catch (const BadBytes& bad) {
        throw InputError(std::string("is damaged: holds ") + bad.what(), {}, "Remove it and run the study again")
            .at(file_.path());
    }
}

/// How many of `left` rows, from row `skip` of block `at` on, can be read in one go from the results file: blocks that
/// are adjacent here may be adjacent there.
std::int64_t Journal::rows_in_file(const Kept& kept, std::size_t at, std::int64_t skip, std::int64_t left) {
    const BlockPlace& place = kept.rows[at];
    std::int64_t some = std::min(place.trials - skip, left);
    while (some < left && ++at < kept.rows.size()) {
        const BlockPlace& next = kept.rows[at];
        if (!next.in_file || next.position != place.position + skip + some) break;
        some = std::min(some + next.trials, left);
    }
    return some;
}

std::vector<double> Journal::values(std::size_t scenario, std::size_t arm, std::size_t column, std::int64_t first,
                                    std::int64_t count) const {
    const Kept& kept = kept_[scenario];
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(count));
    for (std::int64_t row = first, some = 0; row < first + count; row += some) {
        const auto at = static_cast<std::size_t>(row / block_size);
        const BlockPlace& place = kept.rows[at];
        const std::int64_t skip = row % block_size, left = first + count - row;
        if (place.in_file) {
            some = rows_in_file(kept, at, skip, left);
            const std::vector<double> read = (*kept.in_file[arm])(column, place.position + skip, some);
            values.insert(values.end(), read.begin(), read.end());
        } else {
            some = std::min(place.trials - skip, left);
            values.resize(values.size() + static_cast<std::size_t>(some));
            const ColumnType type = kept.types[column];
            read_values(place.position + kept.layout.column_offset(arm, column, place.trials) + skip * value_size(type),
                        type, values.data() + values.size() - some, some);
        }
    }
    return values;
}

}  // namespace credence
