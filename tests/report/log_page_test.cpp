// What the page draws of a log is what is in it: errors within two sigma, NEES and NIS, at their times.

#include "either_way.hpp"
#include "record_support.hpp"

#include <regex>

namespace credence::test::log_page_test {

namespace {

using Points = std::vector<std::pair<double, double>>;

std::vector<double> times_of(const DrawnRecord& record) {
    std::vector<double> times;
    for (int k = 0; k < record.steps; ++k) times.push_back(100 + 0.5 * k + 0.2 * std::sin(k));
    return times;
}

Report report_of(const DrawnRecord& record, const std::vector<double>& times) {
    return report_written([&](const Handle& root) {
        write_drawn(root, record);
        write_values(root, "time", {times.size()}, times);
    });
}

const RunCurves& curves_of(const Report& report) { return report.arms.front().curves.front(); }

/// Those of the path of a class in the drawing whose title begins so.
Points points_of(const std::string& page, const std::string& title, const std::string& classes) {
    const std::size_t at = page.find("-t\">" + title), path = page.find("class=\"" + classes + "\" d=\"", at);
    REQUIRE(at != std::string::npos);
    REQUIRE(path < page.find("</svg>", at));
    const std::string d = page.substr(path, page.find('>', path) - path);
    const std::regex pair("[ML](-?[0-9.]+) (-?[0-9.]+)");
    Points points;
    for (std::sregex_iterator one(d.begin(), d.end(), pair); one != std::sregex_iterator(); ++one)
        points.emplace_back(std::stod((*one)[1]), std::stod((*one)[2]));
    return points;
}

/// Checks that drawn coordinates are the values on a linear scale; returns the scale of their extremes.
std::function<double(double)> check_scale(const std::vector<double>& drawn, const std::vector<double>& values) {
    REQUIRE(drawn.size() == values.size());
    const auto [low, high] = std::ranges::minmax_element(values);
    const auto at = [&](auto value) { return drawn[static_cast<std::size_t>(value - values.begin())]; };
    const double from = *low, slope = (at(high) - at(low)) / (*high - *low), start = at(low);
    const auto scale = [=](double value) { return start + slope * (value - from); };
    for (std::size_t i = 0; i < values.size(); ++i) CHECK(drawn[i] == Approx(scale(values[i])).margin(0.02));
    return scale;
}

std::vector<double> seconds(const Points& points) {
    std::vector<double> all;
    for (const auto& point : points) all.push_back(point.second);
    return all;
}

}  // namespace

TEST_CASE("log page: lines and bands are the record's errors, sigmas, NEES and NIS at their times") {
    const DrawnRecord record(1, 60, 2, 1);
    const std::vector<double> times = times_of(record);
    const std::string page = page_of(report_of(record, times));
    std::vector<double> errors, sigmas, nees, nis, across;
    for (std::size_t k = 0; k < 60; ++k) {
        errors.push_back(record.error[k](1));
        sigmas.push_back(std::sqrt(record.covariance[k](1, 1)));
        nees.push_back(plain_nees(record.error[k], record.covariance[k], {0, 1}) / 2);
        nis.push_back(plain_nees(record.innovation[k], record.innovation_covariance[k], {0}));
    }
    const Points line = points_of(page, "record: error of x1 by step", "line s0");
    for (const auto& point : line) across.push_back(point.first);
    check_scale(across, times);
    const auto up = check_scale(seconds(line), errors);
    const Points band = points_of(page, "record: error of x1 by step", "band");
    REQUIRE(band.size() == 120);
    for (std::size_t k = 0; k < 60; ++k) {
        CHECK(band[k].second == Approx(up(2 * sigmas[k])).margin(0.03));
        CHECK(band[119 - k].second == Approx(up(-2 * sigmas[k])).margin(0.03));
        CHECK(band[k].first == line[k].first);
    }
    check_scale(seconds(points_of(page, "record: NEES/dim of all by step", "line s0")), nees);
    check_scale(seconds(points_of(page, "record: NIS/m of rows: all by step", "line s0")), nis);
    CHECK(page.find("time [s] from 100 s on") != std::string::npos);
}

TEST_CASE("log page: of a long log every stretch keeps its extremes, in its unit and in sigmas") {
    DrawnRecord record(1, 4800, 2);
    record.error[3333](0) = 40;
    const Report report = report_of(record);
    const ErrorCurve& curve = curves_of(report).errors.front();
    std::int64_t outside = 0;
    for (std::size_t first = 0; first < 4800; first += 60) {
        std::size_t extremes[4] = {first, first, first, first};
        for (std::size_t k = first; k < first + 60; ++k) {
            const auto error = [&](std::size_t at) { return record.error[at](0); };
            const auto in_sigmas = [&](std::size_t at) { return error(at) / std::sqrt(record.covariance[at](0, 0)); };
            if (error(k) < error(extremes[0])) extremes[0] = k;
            if (error(k) > error(extremes[1])) extremes[1] = k;
            if (in_sigmas(k) < in_sigmas(extremes[2])) extremes[2] = k;
            if (in_sigmas(k) > in_sigmas(extremes[3])) extremes[3] = k;
            outside += std::abs(in_sigmas(k)) > 2;
        }
        for (const std::size_t k : extremes) {
            const auto kept = std::ranges::find(curve.points, k, &ErrorCurve::Point::step);
            REQUIRE(kept != curve.points.end());
            CHECK(kept->error == record.error[k](0));
            CHECK(kept->sigma == Approx(std::sqrt(record.covariance[k](0, 0))).epsilon(1e-12));
        }
    }
    CHECK(curve.points.size() <= 320);
    CHECK(std::ranges::is_sorted(curve.points, {}, &ErrorCurve::Point::step));
    CHECK(curve.steps == 4800);
    CHECK(curve.outside == outside);
    CHECK(page_of(report).find("largest at step 3334: 40 ") != std::string::npos);
}

TEST_CASE("log page: long gaps, in steps or in time, are left open; the verdict does not know of times") {
    DrawnRecord record(1, 300, 2);
    for (int k = 0; k < 300; ++k)
        if ((k >= 100 && k < 120) || k == 200) record.hide(0, k, 0), record.hide(0, k, 1);
    record.hide(0, 50, 1);  // is not in the state yet
    for (int k = 0; k < 50; ++k) record.hide(0, k, 1);
    std::vector<double> times = times_of(record);
    for (std::size_t k = 250; k < 300; ++k) times[k] += 60;
    const Report plain = report_of(record), timed = report_of(record, times);
    using Gaps = std::vector<std::pair<std::size_t, std::size_t>>;
    CHECK(curves_of(plain).gaps == Gaps{{99, 120}});
    CHECK(curves_of(timed).gaps == Gaps{{99, 120}, {249, 250}});
    CHECK(curves_of(timed).errors[0].steps == 279);
    CHECK(curves_of(timed).errors[1].points.front().step == 51);
    CHECK(report_json(plain) == report_json(timed));
    const std::string page = page_of(timed);
    CHECK(page.find("class=\"gap\"") != std::string::npos);
    CHECK(page.find("NIS/m by step") == std::string::npos);
}

TEST_CASE("log page: a run that fails is drawn up to there, and of many runs none is") {
    DrawnRecord record(1, 60, 2);
    record.covariance[40](0, 0) = -1;
    const Report failed = report_of(record), many = report_of(DrawnRecord(20, 5, 2));
    CHECK(curves_of(failed).errors[0].points.back().step == 39);
    CHECK(page_of(failed).find("record: error of x0 by step") != std::string::npos);
    CHECK(many.arms.front().curves.empty());
    CHECK(page_of(many).find("record: error of") == std::string::npos);
}

}  // namespace credence::test::log_page_test
