// One table as text and as HTML.

#include "catch.hpp"

#include "report/html/html.hpp"
#include "report/table.hpp"

#include <cmath>

namespace credence::test::table_test {

using Catch::Contains;

namespace {

Table example(const std::string& key) {
    Table table("means", {key, "arm", "mean ± 95 %", "failed"}, 2);
    table.group("first");
    table.row({number_cell_as(0.5, "0.5"), "ekf", mean_cell(1.25, {1, 1.5}), count_cell(0)});
    table.row({number_cell_as(10, "10"), "iekf", "-", count_cell(12)});
    return table;
}

}  // namespace

TEST_CASE("table: as text, words are to the left and numbers to the right") {
    CHECK(table_text(example("key")) == "  key  arm   mean ± 95 %  failed\n"
                                        "  first\n"
                                        "  0.5  ekf   1.25 ± 0.25       0\n"
                                        "   10  iekf            -      12\n");
    CHECK(table_text(Table("", {"nothing"})).empty());
}

TEST_CASE("table: row heads have lines of their own where a line would be too long") {
    const std::string key(100, 'k');
    CHECK(table_text(example(key), 0) == key + ", arm\n"
                                         "  mean ± 95 %  failed\n"
                                         "first\n"
                                         "0.5, ekf\n"
                                         "  1.25 ± 0.25       0\n"
                                         "10, iekf\n"
                                         "            -      12\n");
}

TEST_CASE("table: as HTML, numbers carry their exact values") {
    const std::string html = html_of(example("key")).text();
    CHECK_THAT(html,
               Contains("<tr><th scope=\"row\"><data value=\"0.5\">0.5</data></th><th scope=\"row\">ekf</th>"
                        "<td><data value=\"1.25\">1.25</data> ± 0.25</td><td><data value=\"0\">0</data></td></tr>"));
    CHECK_THAT(html, Contains("<th scope=\"rowgroup\" colspan=\"4\">first</th>"));
}

TEST_CASE("table: as CSV, a row has the exact numbers, nothing where there is none, and quotes where it must") {
    CHECK(csv_row({"a,b", number_cell(1.0 / 3, 2), exact_cell(NAN), "say \"so\""}) ==
          "\"a,b\",0.3333333333333333,,\"say \"\"so\"\"\"\n");
}

TEST_CASE("table: a row may have more columns than the heads") {
    Table table("", {"arm", "mean"});
    table.row({"fixed", count_cell(1)});
    table.row({"greedy", count_cell(10), count_cell(3), "word"});
    CHECK(table_text(table, 0) == "arm     mean\n"
                                  "fixed      1\n"
                                  "greedy    10  3  word\n");
}

}  // namespace credence::test::table_test
