// Numbers and lists as text.
// Kind: foreign files.

#include "catch.hpp"

#include <credence/error.hpp>
#include <credence/detail/real.hpp>
#include <credence/text.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace credence::test::text_test {

namespace {
using Parts = std::vector<std::string>;
}

TEST_CASE("text: a number's text reads back to the same bits") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 50000; ++i) {
        const double value = from_bits(random());
        if (std::isnan(value)) continue;
        const std::optional<double> back = to_number(to_text(value));
        REQUIRE(back.has_value());
        REQUIRE(bits_of(*back) == bits_of(value));
    }
}

TEST_CASE("text: a number's text is the shortest") {
    CHECK(to_text(0.1) == "0.1");
    CHECK(to_text(2) == "2");
    CHECK(to_text(0.31415926535897931) == "0.3141592653589793");
    CHECK(to_text(1e300) == "1e+300");
    CHECK(to_text(-0.0) == "-0");
    CHECK(to_text(std::numeric_limits<double>::infinity()) == "inf");
}

TEST_CASE("text: numbers are read whole or not at all") {
    CHECK(to_number("1.5") == 1.5);
    CHECK(to_number("+1.5") == 1.5);
    CHECK(to_number("-1e-3") == -1e-3);
    CHECK(to_number("inf") == std::numeric_limits<double>::infinity());
    CHECK(to_number("-inf") == -std::numeric_limits<double>::infinity());
    CHECK(std::isnan(to_number("nan").value()));
    for (const char* text : {"", " ", "+", "-", "1.5 ", " 1.5", "1,5", "1.5x", "0x10", "1e", "e3", "--1", "++1",
                             "1e999", "one", "1.2.3", "1 2"}) {
        CAPTURE(text);
        CHECK_FALSE(to_number(text).has_value());
    }
}

TEST_CASE("text: whole numbers may be written as 1e6 and must fit") {
    CHECK(to_integer("20") == 20);
    CHECK(to_integer("-3") == -3);
    CHECK(to_integer("1e6") == 1000000);
    CHECK(to_integer("2.5e1") == 25);
    CHECK(to_integer("9223372036854775807") == std::numeric_limits<std::int64_t>::max());
    CHECK(to_integer("-9223372036854775808") == std::numeric_limits<std::int64_t>::min());
    CHECK(to_integer("9007199254740992.0") == 9007199254740992);
    for (const char* text : {"", "1.5", "1e-1", "9223372036854775808", "1e17", "inf", "nan", "-inf", "twelve", "1 000",
                             "0x10", "12a", "1e400"}) {
        CAPTURE(text);
        CHECK_FALSE(to_integer(text).has_value());
    }
}

TEST_CASE("text: white space is trimmed at both ends only") {
    CHECK(trimmed("  a b\t\r") == "a b");
    CHECK(trimmed("a") == "a");
    CHECK(trimmed(" \t ") == "");
    CHECK(trimmed("") == "");
}

TEST_CASE("text: lists are split at commas and trimmed") {
    CHECK(split_list("a, b ,c") == Parts{"a", "b", "c"});
    CHECK(split_list("a") == Parts{"a"});
    CHECK(split_list("") == Parts{});
    CHECK(split_list("   ") == Parts{});
    CHECK(split_list("a,") == Parts{"a", ""});
    CHECK(split_list(",a") == Parts{"", "a"});
    CHECK(split_list("a,,b") == Parts{"a", "", "b"});
    CHECK(split_list("0.5 0.5; 1 2", ';') == Parts{"0.5 0.5", "1 2"});
}

TEST_CASE("text: lists are joined by what they are split at") {
    CHECK(joined({}) == "");
    CHECK(joined({"a"}) == "a");
    CHECK(joined({"a", "b", "c"}) == "a, b, c");
    CHECK(joined({"a", "b"}, "-") == "a-b");
    const Parts parts{"x y", "z"};
    CHECK(split_list(joined(parts)) == parts);
}

TEST_CASE("text: the closest word is found if it is close") {
    const Parts words{"noise.heading", "noise.odometry", "noise.walk", "sensor.noise", "scenario.poses"};
    CHECK(closest("noise.headin", words) == "noise.heading");
    CHECK(closest("noise.odometri", words) == "noise.odometry");
    CHECK(closest("nosie.walk", words) == "noise.walk");
    CHECK(closest("scenario.pose", words) == "scenario.poses");
    CHECK(closest("noise.walk", words) == "noise.walk");
    CHECK(closest("xyzzy", words) == "");
    CHECK(closest("", words) == "");
    CHECK(closest("noise.walk", {}) == "");
}

TEST_CASE("text: UTF-8 is distinguished from similar bytes") {
    for (const char* good : {"", "dm", "\xc2\xb5m", "\xe2\x88\x9a", "\xf0\x9f\x98\x80"}) CHECK(is_utf8(good));
    for (const char* bad :
         {"\x80", "\xc3", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff", "a\xe2\x88"})
        CHECK_FALSE(is_utf8(bad));
}

TEST_CASE("text: what a terminal could obey is escaped, and everything else stays as it is") {
    CHECK(shown("größer µm²\n\ttab") == "größer µm²\n\ttab");
    CHECK(shown("\x1b[31m") == "\\u001b[31m");
    CHECK(shown("\x7f") == "\\u007f");
    CHECK(shown("\xc2\x9b" "31m") == "\\u009b31m");                  // CSI of Latin-1
    CHECK(shown("a\xe2\x80\xae" "b\xe2\x81\xa6" "c") == "a\\u202eb\\u2066c");  // right to left, isolated
    CHECK(shown("\xe2\x80\xa8") == "\\u2028");
    CHECK(shown("\x9b\xff\xe2\x80") == "\\x9b\\xff\\xe2\\x80");      // not UTF-8
    CHECK(shown(std::string("a\0b\r", 4)) == "a\\u0000b\\u000d");
    CHECK(shown("\xc2\xa0\xe2\x80\x8f") == "\xc2\xa0\xe2\x80\x8f");  // a hard blank, a mark of Arabic texts
}

TEST_CASE("text: in a message a name stays on one line, and is cut between characters") {
    CHECK(printable("two\nlines\tand a tab") == "two\\nlines\\tand a tab");
    CHECK(printable("\x1b]0;title\a") == "\\u001b]0;title\\u0007");
    CHECK(printable("abcdef", 4) == "abcd...");
    CHECK(printable("abc\xc2\xb5", 4) == "abc...");
    CHECK(printable("abc\xc2\xb5", 5) == "abc\xc2\xb5");
    CHECK(printable(std::string(10, '\x80'), 4) == "...");
}

TEST_CASE("text: a word of a shell is quoted where it must be") {
    CHECK(shell_word("--sweep") == "--sweep");
    CHECK(shell_word("noise.walk=0.1,0.2") == "noise.walk=0.1,0.2");
    CHECK(shell_word("") == "''");
    CHECK(shell_word("it's $HOME") == "'it'\\''s $HOME'");
    CHECK(shell_word("a\x1b'\\\xc2\xb5.h5") == "$'a\\x1b\\'\\\\\\xc2\\xb5.h5'");
}

TEST_CASE("text: what is far from every word is close to none, however long") {
    CHECK(closest(std::string(300, 'z'), {"noise.heading", "scenario.poses"}) == "");
}

TEST_CASE("text: a number has one sign") {
    CHECK_FALSE(to_number("+-5").has_value());
}

}  // namespace credence::test::text_test
