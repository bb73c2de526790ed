#pragma once
// Ways to damage a results file.

#include "worlds/deformable/keys.hpp"

#include "files/hdf5/write.hpp"
#include "store_study.hpp"

#include <functional>

namespace credence::test {

using hdf5::Handle;

using Change = std::function<void(const Handle& root)>;

/// A way to damage a results file, and a part of what reading it must say.
struct Damage {
    std::string said;
    Change apply;
};

inline Handle open(const Handle& root, const std::string& path) {
    return {H5Oopen(root.id(), path.c_str(), H5P_DEFAULT), H5Oclose, path, "missing"};
}

inline void remove(const Handle& root, const std::string& path) { H5Ldelete(root.id(), path.c_str(), H5P_DEFAULT); }

inline void set_text(const Handle& root, const std::string& path, const std::string& name, const std::string& text) {
    const Handle object = open(root, path);
    H5Adelete(object.id(), name.c_str());
    hdf5::write_text(object, name, text);
}

template <class T>
inline void set_number(const Handle& root, const std::string& path, const std::string& name, T value) {
    const Handle object = open(root, path);
    H5Adelete(object.id(), name.c_str());
    hdf5::write_number<T>(object, name, value);
}

/// Puts a dataset of other type, extents or values in the place of one.
template <class T>
inline void replace(const Handle& root, const std::string& path, const hdf5::Extents& extents, std::vector<T> values) {
    remove(root, path);
    std::size_t count = 1;
    for (const hsize_t extent : extents) count *= extent;
    values.resize(count);
    hdf5::write_dataset(root, path, hdf5::type_of<T>(), values.data(), extents, {"", ""});
}

// The same as changes.
inline Change without(const std::string& path) {
    return [=](const Handle& root) { remove(root, path); };
}
inline Change without_attribute(const std::string& path, const std::string& name) {
    return [=](const Handle& root) { H5Adelete(open(root, path).id(), name.c_str()); };
}
inline Change with_text(const std::string& path, const std::string& name, const std::string& text) {
    return [=](const Handle& root) { set_text(root, path, name, text); };
}
template <class T>
Change with_number(const std::string& path, const std::string& name, T value) {
    return [=](const Handle& root) { set_number<T>(root, path, name, value); };
}
template <class T>
Change replaced(const std::string& path, const hdf5::Extents& extents, const std::vector<T>& values = {}) {
    return [=](const Handle& root) { replace<T>(root, path, extents, values); };
}

/// So that what reads behind the checksum is reached.
inline void forget_checksum(const Handle& dataset) { H5Adelete(dataset.id(), hdf5::checksum_name); }

/// Multiplies the numbers of a dataset; by a power of two the parts of a total stay parts of one.
inline void scale(const Handle& root, const std::string& path, double factor) {
    const Handle dataset = open(root, path);
    const Handle space(H5Dget_space(dataset.id()), H5Sclose, path, "space");
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    REQUIRE(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    for (double& value : values) value *= factor;
    REQUIRE(H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    forget_checksum(dataset);
}

/// A copy of a file after `damage`.
inline std::string damaged_copy(const std::string& good, const std::string& bad, const Change& damage) {
    std::filesystem::copy_file(good, bad, std::filesystem::copy_options::overwrite_existing);
    damage(Handle(H5Fopen(bad.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, bad, "cannot open it"));
    return bad;
}

/// A dataset whose extents promise terabytes that the file does not hold.
inline void promise_terabytes(const Handle& root, const std::string& path) {
    remove(root, path);
    const hsize_t extents[] = {hsize_t{1} << 40}, chunk[] = {1024};
    const Handle space(H5Screate_simple(1, extents, nullptr), H5Sclose, path, "space");
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path, "properties");
    H5Pset_chunk(properties.id(), 1, chunk);
    const Handle dataset(H5Dcreate2(root.id(), path.c_str(), H5T_STD_I64LE, space.id(), H5P_DEFAULT, properties.id(),
                                    H5P_DEFAULT), H5Dclose, path, "dataset");
    const hsize_t one[] = {1};
    const Handle memory(H5Screate_simple(1, one, nullptr), H5Sclose, path, "space");
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, std::vector<hsize_t>{0}.data(), nullptr, one, nullptr);
    const std::int64_t value = 0;
    H5Dwrite(dataset.id(), H5T_NATIVE_INT64, memory.id(), space.id(), H5P_DEFAULT, &value);
}

/// A dataset that keeps its values in another file.
inline void keep_elsewhere(const Handle& root, const std::string& path) {
    remove(root, path);
    const hsize_t extents[] = {5};
    const Handle space(H5Screate_simple(1, extents, nullptr), H5Sclose, path, "space");
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path, "properties");
    H5Pset_external(properties.id(), "/etc/passwd", 0, 40);
    Handle(H5Dcreate2(root.id(), path.c_str(), H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
           H5Dclose, path, "dataset");
}

/// Text as most programs write it, of no fixed length.
inline void write_variable_text(const Handle& root) {
    H5Adelete(root.id(), "study_hash");
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "", ""), space(H5Screate(H5S_SCALAR), H5Sclose, "", "");
    H5Tset_size(type.id(), H5T_VARIABLE);
    const Handle attribute(H5Acreate2(root.id(), "study_hash", type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, "", "");
    const char* text = "text";
    H5Awrite(attribute.id(), type.id(), &text);
}

/// The text of a scenario with one key changed.
inline std::string text_of(const std::string& name, const std::string& key, const std::string& value) {
    DeformableSettings other = scenario(name);
    set_key(other, key, value);
    return scenario_text(other);
}

/// A file is refused after each damage by itself, with what that says, in one line. `write` writes it with a change.
template <class Write, class Read>
void require_refused(const std::vector<Damage>& damages, const Write& write, const Read& read) {
    const TemporaryFolder folder;
    const std::string path = folder / "bad.h5";
    for (const Damage& damage : damages) {
        write(path, damage.apply);
        const std::string said = refusal<InputError>([&] { read(path); });
        INFO("expected: " << damage.said);
        INFO("said: " << said);
        CHECK(said.find(damage.said) != std::string::npos);
        CHECK(said.starts_with(path + ": "));
        CHECK(said.ends_with("."));
        CHECK(said.find('\n') == std::string::npos);
    }
}

/// Likewise a results file of the study.
inline void require_refused(const Study& study, const std::vector<Damage>& damages) {
    const TemporaryFolder folder;
    write_results(folder / "good.h5", study, {{"fact", "x"}});
    const auto write = [&](const std::string& path, const Change& change) {
        const hdf5::QuietErrors quiet;
        damaged_copy(folder / "good.h5", path, change);
    };
    require_refused(damages, write, [](const std::string& path) { read_results(path); });
}

}  // namespace credence::test
