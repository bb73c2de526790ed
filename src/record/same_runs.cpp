#include "record/same_runs.hpp"

#include <credence/text.hpp>

#include "record/read.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

namespace credence {

namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// The first entry of the first dimension whose values differ; nothing where none do.
std::optional<std::uint64_t> first_difference(const RecordDataset& a, const RecordDataset& b) {
    constexpr std::uint64_t most_numbers = 1 << 20;
    const RecordExtents& extents = a.extents();
    std::uint64_t width = 1;
    for (std::size_t d = 1; d < extents.size(); ++d) width *= std::max<std::uint64_t>(extents[d], 1);
    const std::uint64_t rows = std::max<std::uint64_t>(most_numbers / width, 1);
    std::vector<double> of_a, of_b;
    for (std::uint64_t row = 0; row < extents.front(); row += rows) {
        RecordExtents first(extents.size(), 0), count = extents;
        first.front() = row;
        count.front() = std::min(rows, extents.front() - row);
        of_a.resize(count.front() * width);
        of_b.resize(of_a.size());
        a.read(first, count, of_a);
        b.read(first, count, of_b);
        const auto at = std::ranges::mismatch(of_a, of_b, same).in1;
        if (at != of_a.end()) return row + static_cast<std::uint64_t>(at - of_a.begin()) / width;
    }
    return std::nullopt;
}

void require_equal(std::int64_t here, std::int64_t first, const std::string& what) {
    if (here != first)
        throw RecordError("/", "has another number of " + what + ": " + std::to_string(here) +
                                   ", and the first record " + std::to_string(first),
                          "Give records of the same runs and the same state");
}

}  // namespace

void require_same_runs(const RecordSource& first, const RecordSource& record) {
    const std::string remedy = "Give records of the same runs";
    if (const auto seed = record.seed(), other = first.seed(); seed && other && *seed != *other)
        throw RecordError(record_attribute_place("seed"), "is " + std::to_string(*seed) + ", and that of the first "
                          "record " + std::to_string(*other) + ": trials of different seeds are no pairs",
                          "Give records of the same seed");
    for (const char* name : {"component_names", "component_units"}) {
        if (!first.has_attribute(name) || !record.has_attribute(name)) continue;
        const ListEntries here = record.list(name), there = first.list(name);
        const auto text = [](const ListEntries& entries) {
            std::vector<std::string> texts;
            for (const std::vector<std::string>& words : entries) texts.push_back(joined(words, " "));
            return printable(joined(texts));
        };
        if (here != there)
            throw RecordError(record_attribute_place(name),
                              "is " + text(here) + ", and that of the first record " + text(there),
                              "Give records of the same components in the same units and order");
    }
    for (const char* path : {"error", "estimate", "trial", "truth", "truth_covariance", "time", "steps"}) {
        if (!first.has(path) || !record.has(path)) continue;
        const DatasetPointer a = first.open(path, Numbers::any), b = record.open(path, Numbers::any);
        if (a->extents() != b->extents())
            throw RecordError(b->place(), "is " + extents_text(b->extents()) + ", not " + extents_text(a->extents()) +
                                              " as in the first record: these are other runs", remedy);
        if (path == std::string("error") || path == std::string("estimate") || a->extents().empty()) continue;
        if (const std::optional<std::uint64_t> row = first_difference(*a, *b))
            throw RecordError(b->place(), "differs from that of the first record in entry " + std::to_string(*row) +
                                              ": these are other runs", remedy);
    }
}

void SharedSteps::add(const RecordReader& reader) {
    const RecordShape& shape = reader.shape();
    const bool first = of_each.empty();
    if (first) {
        trials = shape.trials, steps = shape.steps, n = shape.n;
        states.resize(static_cast<std::size_t>(trials * steps));
    }
    require_equal(shape.trials, trials, "runs");
    require_equal(shape.steps, steps, "steps");
    require_equal(shape.n, n, "components that are not known exactly");
    of_each.push_back(0);
    of_any = of_all = 0;
    each_checked_step(reader, [&](const RecordStep& step, Presence presence, const CheckedStep& checked) {
        std::uint32_t &known = states[static_cast<std::size_t>(step.trial * steps + step.step)], state = 0;
        // A run with a broken step fails, so that it is in no pair.
        if (presence != Presence::absent) {
            const std::string_view here(checked.here.data(), checked.here.size());
            const bool whole = here.find('\0') == here.npos;
            state = whole ? 2 : std::max<std::uint32_t>(3, std::hash<std::string_view>()(here) & 0xffffffff);
            ++of_each.back();
        }
        if (first) known = state;
        else if (known != state) known = 1;
        of_any += known > 0;
        of_all += known > 1;
    });
}

}  // namespace credence
