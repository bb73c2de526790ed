#include "files/results/columns.hpp"

#include <credence/text.hpp>

#include <algorithm>

namespace credence {

namespace {

using hdf5::Dataset;
using hdf5::Error;
using hdf5::Handle;

/// Number of rows that are read at once where all are checked: it bounds the memory that long columns take.
constexpr std::int64_t rows_at_once = std::int64_t{1} << 17;

template <class T>
std::vector<double> read_rows(const Dataset& dataset, std::int64_t first, std::int64_t count) {
    const std::vector<T> values = dataset.read_some<T>(static_cast<hsize_t>(first), static_cast<hsize_t>(count));
    return {values.begin(), values.end()};
}

std::vector<double> read_rows(const Dataset& dataset, const Column& column, std::int64_t first, std::int64_t count) {
    switch (column.type) {
        case ColumnType::real: return read_rows<double>(dataset, first, count);
        case ColumnType::integer: return read_rows<std::int32_t>(dataset, first, count);
        case ColumnType::status: break;
    }
    std::vector<double> values = read_rows<std::int8_t>(dataset, first, count);
    for (const double value : values)
        if (value < 0 || value >= static_cast<double>(status_names().size()))
            throw Error(dataset.place(), "holds " + to_text(value) + ", which is no status");
    return values;
}

/// The columns of an arm, in a file that stays open for them.
class ColumnsOfFile : public KeptColumns {
public:
    ColumnsOfFile(std::shared_ptr<const Handle> file, std::string path, std::string group, std::vector<Column> columns)
        : file_(std::move(file)), path_(std::move(path)), group_(std::move(group)), columns_(std::move(columns)) {}

    std::vector<double> values(std::size_t column, std::int64_t first, std::int64_t count) const override {
        return hdf5::translated(path_, another_copy, [&] {
            const Dataset dataset(hdf5::open_group(*file_, group_), columns_[column].name);
            return read_rows(dataset, columns_[column], first, count);
        });
    }

private:
    std::shared_ptr<const Handle> file_;
    std::string path_, group_;
    std::vector<Column> columns_;
};

}  // namespace

std::shared_ptr<const KeptColumns> columns_of_file(std::shared_ptr<const Handle> file, const std::string& path,
                                                   const std::string& group, const std::vector<Column>& columns) {
    return std::make_shared<ColumnsOfFile>(std::move(file), path, group, columns);
}

std::optional<std::int64_t> check_column(const Handle& group, const Column& column, std::int64_t trials) {
    const Dataset dataset(group, column.name);
    dataset.require_extents({static_cast<hsize_t>(trials)});
    switch (column.type) {
        case ColumnType::real: dataset.check_all<double>(); return std::nullopt;
        case ColumnType::integer: dataset.check_all<std::int32_t>(); return std::nullopt;
        case ColumnType::status: break;
    }
    dataset.check_all<std::int8_t>();
    std::int64_t counted = 0;
    for (std::int64_t first = 0; first < trials; first += rows_at_once)
        for (const double status : read_rows(dataset, column, first, std::min(rows_at_once, trials - first)))
            counted += !failed(static_cast<Status>(static_cast<int>(status)));
    return counted;
}

BlockRanges read_blocks(const Handle& group, std::int64_t asked) {
    const Dataset dataset(group, "trial");
    if (dataset.extents().size() != 1) throw Error(dataset.place(), "is not a list of numbers");
    dataset.check_all<std::int64_t>();
    const auto rows = static_cast<std::int64_t>(dataset.extents()[0]);
    BlockRanges blocks;
    std::int64_t next = 0, end = 0;  // the next trial, and the end of its block
    for (std::int64_t first = 0; first < rows; first += rows_at_once) {
        const auto count = static_cast<hsize_t>(std::min(rows_at_once, rows - first));
        for (const std::int64_t trial : dataset.read_some<std::int64_t>(static_cast<hsize_t>(first), count)) {
            if (next == end) {
                if (trial < next || trial >= asked || trial % block_size != 0)
                    throw Error(dataset.place(), "does not go on with a block of trials");
                blocks.add(trial / block_size);
                next = trial;
                end = trial + trials_in_block(asked, blocks.back());
            }
            if (trial != next++) throw Error(dataset.place(), "does not count on by one within a block");
        }
    }
    if (next != end) throw Error(dataset.place(), "ends within a block");
    return blocks;
}

}  // namespace credence
