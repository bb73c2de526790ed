#include "files/results/format.hpp"
#include "files/results/parts.hpp"

#include <algorithm>

namespace credence {

namespace {

using hdf5::Dataset;
using hdf5::Error;
using hdf5::Handle;

using Checksums = std::vector<std::uint32_t>;

static_assert(hdf5::values_at_once % block_size == 0);

/// Adds a checksum for every `block_size` values; they begin where one does.
template <class T>
void add_checksums(const std::vector<T>& values, Checksums& sums) {
    for (std::size_t first = 0; first < values.size(); first += block_size)
        sums.push_back(checksum(&values[first], std::min<std::size_t>(block_size, values.size() - first) * sizeof(T)));
}

/// Rows first ... first + count - 1, which are read together with what else their checksums are of.
template <class T>
std::vector<double> read_rows(const Dataset& dataset, const Checksums& expected, std::int64_t first,
                              std::int64_t count) {
    const std::int64_t begin = first / block_size * block_size, wanted = first + count - begin,
                       whole = (wanted + block_size - 1) / block_size * block_size,
                       there = static_cast<std::int64_t>(dataset.extents().at(0)) - begin;
    const std::vector<T> values = dataset.read_some<T>(
        static_cast<hsize_t>(begin), static_cast<hsize_t>(std::max(wanted, std::min(whole, there))));
    Checksums sums;
    add_checksums(values, sums);
    const std::int64_t at = begin / block_size;
    const bool unchanged = at + static_cast<std::int64_t>(sums.size()) <= static_cast<std::int64_t>(expected.size()) &&
                           std::equal(sums.begin(), sums.end(), expected.begin() + at);
    if (!unchanged) throw Error(dataset.place(), "is damaged: its values have changed since they were checked");
    const auto from = values.begin() + (first - begin);
    return {from, from + count};
}

std::vector<double> read_rows(const Dataset& dataset, ColumnType type, const Checksums& sums, std::int64_t first,
                              std::int64_t count) {
    return as_stored(type, [&]<class T>(T) { return read_rows<T>(dataset, sums, first, count); });
}

template <class T>
CheckedColumn check(const Dataset& dataset) {
    CheckedColumn column;
    dataset.read_parts<T>([&](const std::vector<T>& values) { add_checksums(values, column.sums); });
    return column;
}

/// A status that does not exist is reported after the checksum has been compared, which says more.
CheckedColumn check_statuses(const Dataset& dataset) {
    CheckedColumn column{{}, 0};
    std::optional<int> unknown;
    dataset.read_parts<std::int8_t>([&](const std::vector<std::int8_t>& values) {
        add_checksums(values, column.sums);
        for (const int value : values) {
            if (!unknown && (value < 0 || value >= static_cast<int>(status_names().size()))) unknown = value;
            *column.counted += !failed(static_cast<Status>(value));
        }
    });
    if (unknown) throw Error(dataset.place(), "holds " + std::to_string(*unknown) + ", which is no status");
    return column;
}

/// Adds up the blocks of trials as their numbers are read, in order. A problem is reported at the end, likewise.
class BlockReader {
public:
    explicit BlockReader(std::int64_t asked) : asked_(asked) {}
    void add(std::int64_t trial) {
        if (next_ == end_) begin(trial);
        if (trial != next_++) note("does not count on by one within a block");
    }
    BlockRanges blocks(const std::string& place) {
        if (next_ != end_) note("ends within a block");
        if (!problem_.empty()) throw Error(place, problem_);
        return blocks_;
    }

private:
    void begin(std::int64_t trial) {
        if (trial < next_ || trial >= asked_ || trial % block_size != 0)
            return note("does not go on with a block of trials");
        blocks_.add(trial / block_size);
        next_ = trial;
        end_ = trial + trials_in_block(asked_, blocks_.back());
    }
    void note(const std::string& problem) {
        if (problem_.empty()) problem_ = problem;
    }

    std::int64_t asked_, next_ = 0, end_ = 0;  ///< the next trial, and the end of its block
    BlockRanges blocks_;
    std::string problem_;
};

}  // namespace

CheckedColumn check_column(const Handle& group, const Column& column, std::int64_t trials) {
    const Dataset dataset(group, column.name);
    dataset.require_extents({static_cast<hsize_t>(trials)});
    if (column.type == ColumnType::status) return check_statuses(dataset);
    return as_stored(column.type, [&]<class T>(T) { return check<T>(dataset); });
}

std::shared_ptr<const KeptColumns> columns_of_file(std::shared_ptr<const Handle> file, const std::string& path,
                                                   const std::string& group, const std::vector<Column>& columns,
                                                   const std::vector<Checksums>& sums) {
    return std::make_shared<KeptColumns>([=](std::size_t column, std::int64_t first, std::int64_t count) {
        return hdf5::translated(path, another_copy, [&] {
            const Dataset dataset(hdf5::open_group(*file, group), columns[column].name);
            return read_rows(dataset, columns[column].type, sums[column], first, count);
        });
    });
}

BlockRanges read_blocks(const Handle& group, std::int64_t asked) {
    const Dataset dataset = open_list(group, "trial");
    BlockReader reader(asked);
    dataset.read_parts<std::int64_t>([&](const std::vector<std::int64_t>& trials) {
        for (const std::int64_t trial : trials) reader.add(trial);
    });
    return reader.blocks(dataset.place());
}

}  // namespace credence
