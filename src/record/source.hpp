#pragma once
// Where a record is read from: a file, or arrays in memory. Its datasets and attributes have the names of the file.

#include "base/placed_error.hpp"

#include <credence/record.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace credence {

/// An error of a record, at a place that has the name of the file.
class RecordError : public PlacedError {
public:
    RecordError(const std::string& place, const std::string& problem, const std::string& remedy = {},
                std::string of_arrays = {})
        : PlacedError(place, problem, remedy), of_arrays_(std::move(of_arrays)) {}
    /// The remedy of a caller in Python, who gives arrays in memory.
    const std::string& remedy_of_arrays() const { return of_arrays_.empty() ? complaint().remedy : of_arrays_; }

private:
    std::string of_arrays_;
};

using RecordExtents = std::vector<std::uint64_t>;

/// The numbers that a dataset may contain.
enum class Numbers { floating, any };

/// A dataset of a record, read in parts as doubles.
class RecordDataset {
public:
    /// Values at first ... first + count - 1 in each dimension, row-major. `values` has as many.
    using Read =
        std::function<void(const RecordExtents& first, const RecordExtents& count, std::vector<double>& values)>;
    RecordDataset(std::string place, RecordExtents extents, double epsilon, std::uint64_t chunk, Read read_part)
        : read(std::move(read_part)),
          place_(std::move(place)),
          extents_(std::move(extents)),
          epsilon_(epsilon),
          chunk_(chunk) {}

    const Read read;
    const std::string& place() const { return place_; }
    const RecordExtents& extents() const { return extents_; }
    /// Distance of 1 from the next number of the type, at least 2^-52.
    double epsilon() const { return epsilon_; }
    /// How many entries of the first dimension are stored together.
    std::uint64_t chunk() const { return chunk_; }

private:
    std::string place_;
    RecordExtents extents_;
    double epsilon_;
    std::uint64_t chunk_;
};
using DatasetPointer = std::shared_ptr<const RecordDataset>;

/// The entries of a list, each of words: a name, and behind it the members of a group.
using ListEntries = std::vector<std::vector<std::string>>;
/// Those between the commas of a text.
ListEntries list_entries(const std::string& text);

/// The datasets and attributes of a record. Paths are such as `error` and `group/pose/nees`, and the empty one is that
/// of the root. All functions throw PlacedError: RecordError, or that of the file.
class RecordSource {
public:
    virtual ~RecordSource() = default;

    virtual bool has(const std::string& path) const = 0;
    /// Throws where it is missing, or cannot be read.
    virtual DatasetPointer open(const std::string& path, Numbers numbers = Numbers::floating) const = 0;
    /// What a group holds, in alphabetical order; nothing where there is no such group.
    virtual std::vector<std::string> names_in(const std::string& group) const = 0;

    /// An attribute of the object at a path.
    virtual bool has_attribute(const std::string& name, const std::string& path = "") const = 0;
    /// A text attribute; the entries of a list joined by commas.
    virtual std::string text(const std::string& name, const std::string& path = "") const = 0;
    /// A list attribute of the root.
    virtual ListEntries list(const std::string& name) const { return list_entries(text(name)); }
    /// The number in an attribute, of any type; nothing where it holds anything else.
    virtual std::optional<double> number(const std::string& name, const std::string& path = "") const = 0;
    /// The attribute `seed` of the root: that of the random numbers of its trials, where it says so.
    virtual std::optional<std::uint64_t> seed() const { return std::nullopt; }
};

/// Names for messages, as in a file: `/group/pose/nees`, `/@groups`; of arrays those of arguments: `nees`, `groups`.
std::string record_place(const std::string& path);
std::string record_attribute_place(const std::string& name, const std::string& path = "");

/// While an object exists, places that this thread names are those of arrays.
struct PlacesAreArrays {
    static inline thread_local bool now = false;
    PlacesAreArrays() { now = true; }
    ~PlacesAreArrays() { now = false; }
};

/// A record in arrays, which must outlive it and its datasets.
class ArraySource : public RecordSource {
public:
    explicit ArraySource(const RecordArrays& record) : record_(record) {}
    bool has(const std::string& path) const override;
    DatasetPointer open(const std::string& path, Numbers numbers) const override;
    std::vector<std::string> names_in(const std::string& group) const override;
    bool has_attribute(const std::string& name, const std::string& path) const override;
    std::string text(const std::string& name, const std::string& path) const override;
    ListEntries list(const std::string& name) const override;
    std::optional<double> number(const std::string& name, const std::string& path) const override;

private:
    const RecordArrays& record_;
};

}  // namespace credence
