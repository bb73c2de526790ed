// A file with many objects is read in time proportional to their number.

#include <ctime>

#include "catch.hpp"
#include "record_support.hpp"

namespace credence::test::many_objects_test {

TEST_CASE("hdf5: opening and closing an object takes no longer after thousands of others") {
    constexpr int objects = 20000, part = 1000;
    const TemporaryFolder folder;
    write_file(folder / "many.h5", [](const Handle& root) {
        for (int i = 0; i < objects; ++i) write_values(root, "d" + std::to_string(i), {1}, {1.0});
    });
    const hdf5::QuietErrors quiet;
    const Handle file = hdf5::open_file(folder / "many.h5");
    const auto seconds = [&](int first) {  // of the processor, so that other programs do not count
        const std::clock_t start = std::clock();
        for (int i = first; i < first + part; ++i) {
            const Handle one(H5Dopen2(file.id(), ("d" + std::to_string(i)).c_str(), H5P_DEFAULT), H5Dclose, "d",
                             "no data");
            REQUIRE(one.id() >= 0);
        }
        return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    };
    const double first = seconds(0);
    for (int i = part; i + part < objects; i += part) seconds(i);
    CHECK(seconds(objects - part) < 3 * first);  // it grew with the number of those before: sixfold, here
}

}  // namespace credence::test::many_objects_test
