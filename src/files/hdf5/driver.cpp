// An HDF5 file driver that writes through a ByteFile. HDF5 may crash at exit after the system refused a write; through
// this driver HDF5 never sees such an error: the ByteFile keeps the first one and ignores later writes.

#include "files/hdf5/write.hpp"
#include "files/system/byte_file.hpp"

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <iterator>
#include <memory>

namespace credence::hdf5 {

namespace {

/// HDF5's structure for an open file; HDF5's own part must come first.
struct Driven {
    H5FD_t own;
    ByteFile* bytes;
    haddr_t end;  ///< of what HDF5 has allocated
};

Driven& driven(H5FD_t* file) { return *reinterpret_cast<Driven*>(file); }
const Driven& driven(const H5FD_t* file) { return *reinterpret_cast<const Driven*>(file); }

constexpr haddr_t largest_address = (haddr_t{1} << 62) - 1;

H5FD_t* open_driven(const char*, unsigned, hid_t access, haddr_t) {
    const auto bytes = static_cast<ByteFile* const*>(H5Pget_driver_info(access));
    if (bytes == nullptr) return nullptr;
    auto file = std::make_unique<Driven>();
    file->bytes = *bytes;
    return &file.release()->own;
}

herr_t close_driven(H5FD_t* file) {
    delete &driven(file);
    return 0;
}

herr_t features(const H5FD_t*, unsigned long* flags) {
    if (flags != nullptr)
        *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
                 H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) { return driven(file).end; }

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    driven(file).end = end;
    return 0;
}

haddr_t written_end(const H5FD_t* file, H5FD_mem_t) { return driven(file).bytes->size(); }

herr_t read_driven(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* buffer) {
    driven(file).bytes->read(address, buffer, size);
    return 0;
}

herr_t write_driven(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* buffer) {
    driven(file).bytes->write(address, buffer, size);
    return 0;
}

herr_t truncate_driven(H5FD_t* file, hid_t, hbool_t) {
    Driven& own = driven(file);
    if (own.bytes->size() != own.end) own.bytes->resize(own.end);
    return 0;
}

H5FD_class_t driver_class() {
    H5FD_class_t driver{};
#if H5_VERSION_GE(1, 13, 0)
    driver.version = H5FD_CLASS_VERSION;
    driver.value = static_cast<H5FD_class_value_t>(512);  // the first number that HDF5 reserves for tests
#endif
    driver.name = "credence";
    driver.maxaddr = largest_address;
    driver.fc_degree = H5F_CLOSE_STRONG;
    driver.fapl_size = sizeof(ByteFile*);
    driver.open = open_driven;
    driver.close = close_driven;
    driver.query = features;
    driver.get_eoa = allocated_end;
    driver.set_eoa = set_allocated_end;
    driver.get_eof = written_end;
    driver.read = read_driven;
    driver.write = write_driven;
    driver.truncate = truncate_driven;
    const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(map), std::end(map), driver.fl_map);
    return driver;
}

/// Registers the driver once for the process; HDF5 unregisters it at exit.
hid_t driver_id() {
    static const H5FD_class_t driver = driver_class();
    static const hid_t id = H5FDregister(&driver);
    return id;
}

}  // namespace

Handle new_file(ByteFile& bytes) {
    const std::string place = "/", problem = "HDF5 could not make a file";
    const Handle access = new_properties(H5P_FILE_ACCESS, place);
    ByteFile* const target = &bytes;
    check(H5Pset_driver(access.id(), driver_id(), &target), place, problem);
    check(H5Pset_libver_bounds(access.id(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18), place, problem);
    const Handle creation = new_properties(H5P_FILE_CREATE, place);
    constexpr unsigned order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
    check(H5Pset_obj_track_times(creation.id(), false), place, problem);
    check(H5Pset_attr_creation_order(creation.id(), order), place, problem);
    check(H5Pset_link_creation_order(creation.id(), order), place, problem);
    return {H5Fcreate("results", H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose, place, problem};
}

}  // namespace credence::hdf5
