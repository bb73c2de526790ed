// Runs of a record that are copies of others.

#include "catch.hpp"
#include "record_support.hpp"

namespace credence::test::record_copies_test {

TEST_CASE("record: a run that is a copy of another has failed, and is named") {
    DrawnRecord drawn(60, 5, 2);
    const auto read = [&] { return read_written([&](const Handle& root) { write_drawn(root, drawn); }); };
    CHECK(read().trouble_count == 0);
    for (int k = 0; k < drawn.steps; ++k) drawn.error[drawn.at(41, k)] = drawn.error[drawn.at(3, k)];
    const Record record = read();
    REQUIRE(record.troubles.size() == 1);
    CHECK(record.troubles[0].trial == 41);
    CHECK(record.troubles[0].what == "its errors are those of trial 3, to the last bit: it is a copy");
    CHECK(record.results.not_judged.at(0).starts_with("Only 59 of the 60 runs are distinct: 1 have"));
    drawn.error[drawn.at(41, 4)][1] += 1e-9;
    CHECK(read().trouble_count == 0);
    for (Eigen::VectorXd& error : drawn.error) error = error.array().round();  // of few values: 10 of them a run
    for (int k = 0; k < drawn.steps; ++k) drawn.error[drawn.at(41, k)] = drawn.error[drawn.at(3, k)];
    CHECK(read().trouble_count == 1);
    for (Eigen::VectorXd& error : drawn.error) error = (error.array() > 1).cast<double>();
    CHECK(read().trouble_count == 0);
}

}  // namespace credence::test::record_copies_test
