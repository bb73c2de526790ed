#pragma once
// A record in an HDF5 file.

#include "files/hdf5/handle.hpp"
#include "record/same_runs.hpp"
#include "record/source.hpp"

#include <credence/record.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace credence {

/// A record in a file, as long as its root is open.
class FileSource : public RecordSource {
public:
    /// The attributes `given` take the place of those of the root.
    explicit FileSource(const hdf5::Handle& root, std::map<std::string, std::string> given = {})
        : root_(root), given_(std::move(given)) {}
    bool has(const std::string& path) const override;
    DatasetPointer open(const std::string& path, Numbers numbers) const override;
    std::vector<std::string> names_in(const std::string& group) const override;
    bool has_attribute(const std::string& name, const std::string& path) const override;
    std::string text(const std::string& name, const std::string& path) const override;
    std::optional<double> number(const std::string& name, const std::string& path) const override;
    std::optional<std::uint64_t> seed() const override;

private:
    const hdf5::Handle& root_;
    std::map<std::string, std::string> given_;
};

/// The records of a file, by the paths that `read_record` takes: its own, or FILE:ARM for each group that the root's
/// attribute `arms` names; of FILE:ARM that one. Throws InputError where it cannot be read.
std::vector<std::string> records_in(const std::string& path);
/// Records of the same runs, by their paths, with the steps that all have; `added`: the same once more, with the
/// covariance of the truth's errors added to P, empty unless all have it. Throws InputError naming what shows that one
/// is not of the runs of the first [require_same_runs].
std::vector<Record> read_same_runs(const std::vector<std::string>& paths, SharedSteps& shared,
                                   std::vector<Record>& added);

/// The file of such a path.
std::string record_file(const std::string& path);

}  // namespace credence
