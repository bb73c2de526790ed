// Studies that must agree because the world does not know the difference: its unit of length, and its end.

#include "store_study.hpp"
#include "worlds/deformable/keys.hpp"

#include <credence/columns.hpp>

namespace credence::test::metamorphic_test {

namespace {

const std::vector<std::pair<std::string, double>> lengths{
    {"features.step", 2},     {"features.sway_amplitude", 0.25}, {"sensor.range_min", 0.1},  {"sensor.range_max", 2},
    {"sensor.sigma", 0.05},   {"sensor.sigma_near", 0.01},       {"sensor.sigma_far", 0.09}, {"noise.odometry", 0.02},
    {"noise.walk", 0.3},      {"noise.deformation", 0.2},        {"noise.initial_position", 0.1}};

/// A scenario with one arm whose unit of length is 1/factor of another's.
DeformableSettings scaled(double factor, const std::string& process, const std::string& more, int poses = 8) {
    DeformableSettings settings = read_deformable_text("[scenario]\nname = one\nposes = " + std::to_string(poses) +
                                                           "\n[arms]\ncontrollers = fixed\n[model]\nprocess = " +
                                                           process + "\n" + more,
                                                       "one", "one");
    std::string positions;
    for (const auto& [x, y] : {std::pair{0.5, 0.5}, {0.9, 0.8}, {0.3, 0.4}})
        positions += (positions.empty() ? "" : ", ") + to_text(x * factor) + " " + to_text(y * factor);
    set_key(settings, "features.positions", positions);
    for (const auto& [key, value] : lengths) set_key(settings, key, to_text(value * factor));
    return settings;
}

Study study_of(const DeformableSettings& settings) {
    Study study = new_study({settings}, 7);
    run_study(study, {256, 1, {}});
    return study;
}

/// Whether the first `steps` steps have the same totals in the series without a unit.
void check_same_steps(const ScenarioResults& a, const ScenarioResults& b, std::size_t steps) {
    std::size_t compared = 0;
    for (std::size_t f = 0; f < a.all_series.size(); ++f) {
        if (a.all_series[f].unit != "1") continue;
        CAPTURE(a.all_series[f].name);
        for (std::size_t k = 0; k < steps; ++k)
            REQUIRE(a.arms[0].totals.series[f].sum[k].parts() == b.arms[0].totals.series[f].sum[k].parts());
        ++compared;
    }
    CHECK(compared > 10);
}

}  // namespace

TEST_CASE("metamorphic: in a unit of length a power of two apart all numbers without a unit have the same bits") {
    for (const std::string process : {"heading", "translation"})
        for (const std::string more : {"", "[features]\npath = circle\n[sensor]\nnoise = ranged\n"}) {
            const Study study = study_of(scaled(1, process, more));
            for (const double factor : {0x1p-30, 0.125, 4.0, 0x1p10}) {
                CAPTURE(process, more, factor);
                const Study other = study_of(scaled(factor, process, more));
                const ScenarioResults &a = study.scenarios[0], &b = other.scenarios[0];
                check_same_steps(a, b, static_cast<std::size_t>(a.steps()));
                for (const std::size_t column : {column_unseen, column_nees_ratio, column_nis_ratio})
                    CHECK(a.arms[0].columns.in_memory()[column] == b.arms[0].columns.in_memory()[column]);
            }
        }
}

TEST_CASE("metamorphic: a trial that goes on for longer begins as the shorter one") {
    for (const std::string process : {"heading", "translation"}) {
        const Study study = study_of(scaled(1, process, "", 8)), longer = study_of(scaled(1, process, "", 20));
        check_same_steps(study.scenarios[0], longer.scenarios[0], 7);
    }
}

}  // namespace credence::test::metamorphic_test
