// A record in an HDF5 file.

#include "files/record.hpp"

#include <credence/detail/store.hpp>
#include <credence/text.hpp>

#include "files/hdf5/read.hpp"
#include "record/read.hpp"

#include <algorithm>

namespace credence {

namespace {

using hdf5::Handle;

/// Calls `use` with the group that holds the last name of a path, and with that name. Every group on the way is opened
/// by itself, because none of them may be a link to somewhere else.
template <class Use>
auto at_path(const Handle& group, const std::string& path, const Use& use) {
    const std::size_t slash = path.find('/');
    if (slash == std::string::npos) return use(group, path);
    return at_path(hdf5::open_group(group, path.substr(0, slash)), path.substr(slash + 1), use);
}

DatasetPointer file_dataset(const Handle& group, const std::string& name, Numbers numbers) {
    const auto dataset = std::make_shared<const hdf5::RealDataset>(group, name, numbers == Numbers::any);
    return std::make_shared<RecordDataset>(
        dataset->place(), RecordExtents(dataset->extents().begin(), dataset->extents().end()), dataset->epsilon(),
        dataset->chunk().empty() ? 1 : dataset->chunk().front(),
        [dataset](const RecordExtents& first, const RecordExtents& count, std::vector<double>& values) {
            dataset->read({first.begin(), first.end()}, {count.begin(), count.end()}, values);
        });
}

/// Throws where `name` is a group, as Octave's own `save -hdf5` writes variables.
void refuse_group(const Handle& parent, const std::string& name) {
    const std::string place = hdf5::place_of(parent, name);
    const Handle object(H5Oopen(parent.id(), hdf5::hard(parent, name).c_str(), H5P_DEFAULT), H5Oclose, place,
                        "cannot be opened");
    if (H5Iget_type(object.id()) == H5I_GROUP)
        throw RecordError(place, "is a group, not a dataset, as Octave's save makes it",
                          "Write a dataset of that name, in Octave with nccreate and ncwrite of the package netcdf");
}

/// The name by which HDF5 finds an object from the root.
const char* object_name(const std::string& path) { return path.empty() ? "." : path.c_str(); }

/// The number in an attribute, read as T, HDF5's `native`; nothing where it holds anything else.
template <class T>
std::optional<T> read_number(const Handle& root, const std::string& name, const std::string& path, hid_t native) {
    const std::string place = record_attribute_place(name, path);
    const Handle attribute(H5Aopen_by_name(root.id(), object_name(path), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, place, "HDF5 cannot open it");
    const Handle type(H5Aget_type(attribute.id()), H5Tclose, place, "HDF5 cannot read its type");
    const Handle space(H5Aget_space(attribute.id()), H5Sclose, place, "HDF5 cannot read its extents");
    const H5T_class_t kind = H5Tget_class(type.id());
    if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || H5Sget_simple_extent_npoints(space.id()) != 1)
        return std::nullopt;
    if (kind == H5T_INTEGER) hdf5::require_bits(type, place);
    T number = 0;
    hdf5::check(H5Aread(attribute.id(), native, &number), place, "HDF5 cannot read it");
    return number;
}

/// A path FILE:ARM as both; the arm is empty where the path is that of a file.
std::pair<std::string, std::string> parted(const std::string& path) {
    const std::size_t colon = path.rfind(':');
    if (colon == std::string::npos || identity_of(path) || !identity_of(path.substr(0, colon))) return {path, ""};
    return {path.substr(0, colon), path.substr(colon + 1)};
}

std::vector<std::string> arms_of(const Handle& root) {
    return hdf5::has_attribute(root, "arms") ? split_list(hdf5::read_any_text(root, "arms"))
                                             : std::vector<std::string>();
}

std::vector<std::string> paths_of(const std::string& file, std::vector<std::string> arms) {
    for (std::string& arm : arms) arm = file + ":" + arm;
    return arms;
}

/// Calls `use` with the record of one arm, which is the file's root where it has no arms.
template <class Use>
auto of_arm(const Handle& root, const std::string& file, const std::string& arm, const Use& use) {
    const std::vector<std::string> arms = arms_of(root);
    if (arms.empty() && arm.empty()) return use(root);
    const std::string& name = arms.size() == 1 && arm.empty() ? arms.front() : arm;
    if (std::ranges::find(arms, name) == arms.end())
        throw RecordError("/", name.empty() ? "holds several arms" : "has no arm " + printable(name),
                          arms.empty() ? "It is one record" : "Name one as " + joined(paths_of(file, arms), " or "));
    return at_path(root, name + "/", [&](const Handle& record, const std::string&) { return use(record); });
}

using Attributes = std::map<std::string, std::string>;

/// Calls `use` with the source of a record.
template <class Use>
auto with_source(const std::string& path, const Attributes& attributes, const Use& use) {
    const auto named = parted(path);
    return hdf5::read_file(named.first,
                           "A record holds `error` [trial, step, n] and `covariance` [trial, step, n, n], may hold "
                           "`innovation` [trial, step, m] and `innovation_covariance` [trial, step, m, m], and may "
                           "name component groups in the attribute `groups`, such as `pose 0:3, feature_1 3:5`",
                           [&](const Handle& root) {
                               return of_arm(root, named.first, named.second,
                                             [&](const Handle& group) { return use(FileSource(group, attributes)); });
                           });
}

/// `shared`: the steps that count; none: all.
Record read_steps(const std::string& path, const std::function<void(const Progress&)>& progress, int segments,
                  const Attributes& attributes, const SharedSteps* shared, TruthUse truth = TruthUse::beside) {
    const OpenAgain again = [path, attributes](const std::function<void(RecordReader)>& use) {
        with_source(path, attributes, [&](const FileSource& source) { return use(RecordReader(source)), true; });
    };
    Record read = with_source(path, attributes, [&](const FileSource& source) {
        RecordReader reader(source);
        if (shared != nullptr)
            reader.compare([shared](std::int64_t trial, int step) { return shared->have(trial, step); });
        reader.use_truth(truth);
        Record record = read_record(std::move(reader), path, progress, segments, again);
        if (source.has_attribute("log", "")) record.log = source.text("log", "");
        return record;
    });
    if (const std::string arm = parted(path).second; !arm.empty()) read.results.arms.front().name = arm;
    return read;
}

}  // namespace

bool FileSource::has(const std::string& path) const {
    return at_path(root_, path,
                   [](const Handle& group, const std::string& name) { return hdf5::has_link(group, name); });
}

DatasetPointer FileSource::open(const std::string& path, Numbers numbers) const {
    return at_path(root_, path, [&](const Handle& group, const std::string& name) {
        refuse_group(group, name);
        return file_dataset(group, name, numbers);
    });
}

std::vector<std::string> FileSource::names_in(const std::string& group) const {
    if (!has(group)) return {};
    return at_path(root_, group, [](const Handle& parent, const std::string& name) {
        return hdf5::sorted_link_names(hdf5::open_group(parent, name));
    });
}

bool FileSource::has_attribute(const std::string& name, const std::string& path) const {
    if (path.empty() && given_.contains(name)) return true;
    const htri_t answer = H5Aexists_by_name(root_.id(), object_name(path), name.c_str(), H5P_DEFAULT);
    hdf5::check(answer, record_attribute_place(name, path), "cannot be looked up");
    return answer > 0;
}

std::string FileSource::text(const std::string& name, const std::string& path) const {
    if (const auto given = given_.find(name); path.empty() && given != given_.end()) return given->second;
    const Handle object(H5Oopen(root_.id(), object_name(path), H5P_DEFAULT), H5Oclose,
                        record_attribute_place(name, path), "HDF5 cannot open it");
    return hdf5::read_any_text(object, name);
}

std::optional<double> FileSource::number(const std::string& name, const std::string& path) const {
    return read_number<double>(root_, name, path, H5T_NATIVE_DOUBLE);
}

std::optional<std::uint64_t> FileSource::seed() const {
    if (!has_attribute("seed", "")) return std::nullopt;
    return read_number<std::uint64_t>(root_, "seed", "", H5T_NATIVE_UINT64);
}

Record read_record(const std::string& path, const std::function<void(const Progress&)>& progress, int segments,
                   const Attributes& attributes) {
    return read_steps(path, progress, segments, attributes, nullptr);
}

std::string record_file(const std::string& path) { return parted(path).first; }

std::vector<std::string> records_in(const std::string& path) {
    if (record_file(path) != path) return {path};
    const std::vector<std::string> records = paths_of(path, hdf5::read_file(path, "A record", arms_of));
    return records.empty() ? std::vector{path} : records;
}

void require_same_runs(const std::string& first, const std::string& path) {
    with_source(first, {}, [&](const FileSource& one) {
        return with_source(path, {}, [&](const FileSource& other) { return require_same_runs(one, other), true; });
    });
}

std::vector<Record> read_same_runs(const std::vector<std::string>& paths, SharedSteps& shared,
                                   std::vector<Record>& added) {
    bool all_have_truth = true;
    for (const std::string& path : paths) {
        if (path != paths.front()) require_same_runs(paths.front(), path);
        all_have_truth &= with_source(path, {}, [&](const FileSource& source) {
            const RecordReader reader(source);
            shared.add(reader);
            return reader.shape().has_truth_covariance;
        });
    }
    const auto read = [&](TruthUse truth) {
        std::vector<Record> records;
        for (const std::string& path : paths) records.push_back(read_steps(path, {}, segments_off, {}, &shared, truth));
        return records;
    };
    if (all_have_truth) added = read(TruthUse::added);
    return read(TruthUse::beside);
}

}  // namespace credence
