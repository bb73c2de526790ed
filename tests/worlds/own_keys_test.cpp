// Keys of users' worlds that are lists and choices.

#include "catch.hpp"

#include <credence/error.hpp>
#include <credence/detail/own_keys.hpp>

namespace credence::test::own_keys_test {

namespace {

enum class Chart { own, plane };
struct Settings {
    std::vector<double> places{1, 2.5};
    Chart chart = Chart::own;
};
using All = OwnSettings<Settings>;

OwnKeys<Settings> keys() {
    OwnKeys<Settings> all;
    all.reals("beacons.x", &Settings::places, -10, 10, "of each (m)");
    all.choice("filter.chart", &Settings::chart, {"own", "plane"}, "of errors");
    return all;
}

std::string read_back(const std::string& name, const std::string& text) {
    All settings;
    const OwnKeys<Settings> all = keys();
    set_key(all.list(), settings, name, text);
    for (const KeyOf<All>& key : all.list())
        if (key.name == name) return key.get(settings);
    return "";
}

}  // namespace

TEST_CASE("keys: a world's lists and choices are read, shown, and refused by name") {
    CHECK(keys().list().back().get(All()) == "own");
    CHECK(keys().list()[keys().list().size() - 2].get(All()) == "1, 2.5");
    CHECK(read_back("beacons.x", " -3 ,4e-1,10") == "-3, 0.4, 10");
    CHECK(read_back("beacons.x", "7") == "7");
    CHECK(read_back("filter.chart", "plane") == "plane");
    const auto refused = [](const std::string& name, const std::string& text, const std::string& message) {
        CHECK_THROWS_WITH(read_back(name, text), message);
    };
    refused("beacons.x", "1, 11",
            "invalid beacons.x=11 (must be at least -10 and at most 10). Give a number in that range.");
    refused("beacons.x", "1,,2", "invalid beacons.x= (not a number). It must be at least -10 and at most 10.");
    refused("beacons.x", "1 2", "invalid beacons.x=1 2 (blanks part what commas should). Write 1, 2.");
    refused("beacons.x", "", "invalid beacons.x= (it is empty). Give at least one number.");
    refused("filter.chart", "polar", "invalid filter.chart=polar (not one of its choices). Give one of own, plane.");
}

}  // namespace credence::test::own_keys_test
