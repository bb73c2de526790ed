// Parsing of goals, and the parts of a study that they refer to.

#include "catch.hpp"
#include "study_support.hpp"

#include <credence/error.hpp>
#include "study/stopping.hpp"

namespace credence::test::stopping_goal_test {

using Catch::Contains;
using Catch::Matchers::WithinRel;

namespace {

std::string refusal_of(const std::string& goal, const Study& study) {
    try {
        check_goals({parse_goal(goal)}, study);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("stopping: a goal is a mean or a paired difference, absolute or relative") {
    const StoppingGoal relative = parse_goal("trace_P=0.5%");
    CHECK(relative.text == "trace_P=0.5%");
    CHECK(relative.metric == "trace_P");
    CHECK(relative.kind == WidthKind::relative);
    CHECK_THAT(relative.half_width, WithinRel(0.005, 1e-15));
    CHECK_FALSE(relative.is_pair());
    const StoppingGoal pair = parse_goal(" trace_P [ greedy.ekf - fixed ] = 1e-2 ");
    CHECK(pair.metric == "trace_P");
    CHECK(pair.minuend == "greedy.ekf");
    CHECK(pair.subtrahend == "fixed");
    CHECK(pair.kind == WidthKind::absolute);
    CHECK(pair.half_width == 0.01);
    CHECK(parse_goal("unseen[greedy-fixed]=2 %").kind == WidthKind::relative);
}

TEST_CASE("stopping: what is no goal is refused, saying why") {
    const std::vector<std::pair<std::string, std::string>> refused{
        {"", "there is no = in it"}, {"trace_P", "there is no = in it"}, {"=1", "there is no name before the ="},
        {"[greedy-fixed]=1", "no name"}, {"trace_P=", "not a number"}, {"trace_P=x", "not a number"},
        {"trace_P=%", "not a number"}, {"trace_P=1%%", "not a number"}, {"trace_P=0", "above 0"},
        {"trace_P=0%", "above 0"}, {"trace_P=-1", "above 0"}, {"trace_P=nan", "above 0"}, {"trace_P=inf", "finite"},
        {"trace_P=1e-324%", "not a number"}, {"trace_P[greedy]=1", "two arms"}, {"trace_P[a-b-c]=1", "two arms"},
        {"trace_P[-fixed]=1", "two arms"}, {"trace_P[]=1", "two arms"}, {"trace_P[a-b=1", "not closed"},
        {"trace_P[a-b]c=1", "not closed"}};
    for (const auto& [text, why] : refused) {
        CAPTURE(text);
        CHECK_THROWS_WITH(parse_goal(text), Contains("invalid --until=" + text) && Contains(why));
    }
}

TEST_CASE("stopping: goals of which the study has not the column or the arms are refused, with what it has") {
    Study study = new_study(small_scenarios(), 1);
    CHECK(refusal_of("trace_P=1", study).empty());
    CHECK(refusal_of("unseen[greedy-fixed]=1", study).empty());
    CHECK(refusal_of("unseen[greedy.kf-fixed]=1", study).empty());  // one scenario has both
    CHECK_THAT(refusal_of("trase_P=1", study), Contains("Did you mean trace_P?") && Contains("nees_ratio, nis_ratio"));
    CHECK_THAT(refusal_of("nonsense=1", study), Contains("there is no column nonsense). There are trace_P, unseen"));
    CHECK_THAT(refusal_of("status=1", study), Contains("there is no column status"));
    CHECK_THAT(refusal_of("status_pose=1", study), Contains("there is no column status_pose"));
    CHECK_THAT(refusal_of("trace_P[greedy-fixt]=1", study), Contains("has an arm fixt). Did you mean fixed?"));
    CHECK_THAT(refusal_of("trace_P[greedy.ekf-fixed.kf]=1", study), Contains("has both greedy.ekf and fixed.kf"));
    CHECK_THAT(refusal_of("trace_P[greedy-greedy]=1", study), Contains("an arm less itself"));
    CHECK_THAT(refusal_of("trace_P[greedy-greedy.kf]=1", study), Contains("an arm less itself"));
    // Two estimators under one controller: no scenario key allows that yet.
    study.scenarios[0].arms.push_back(study.scenarios[0].arms[1]);
    study.scenarios[0].arms.back().name = "greedy.other";
    CHECK_THAT(refusal_of("trace_P[greedy-fixed]=1", study), Contains("Name one of greedy.ekf, greedy.other"));
    CHECK(refusal_of("trace_P[greedy.other-greedy.ekf]=1", study).empty());
}

}  // namespace credence::test::stopping_goal_test
