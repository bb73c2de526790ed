#include "program.hpp"

#include "catch.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace credence::test {

namespace {

std::string read_file(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

}  // namespace

void Workplace::write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Workplace::read(const std::string& name) const { return read_file(folder_ / name); }

std::vector<std::string> Workplace::names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

Outcome Workplace::credence(const std::string& arguments) const { return shell(CREDENCE_PROGRAM " " + arguments); }

Outcome Workplace::shell(const std::string& command) const {
    // What the command prints goes beside the folder, so that the folder holds what the program wrote and nothing else.
    const std::string out = folder_.path().string() + ".out", err = folder_.path().string() + ".err";
    const std::string quoted = "cd " + folder_.path().string() + " && { " + command + "\n} >" + out + " 2>" + err;
    const int status = std::system(quoted.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return outcome;
}

void check_refused(const Outcome& outcome, const std::string& said, int exit_code) {
    CAPTURE(outcome.err, outcome.out);
    CHECK(outcome.exit_code == exit_code);
    CHECK_THAT(outcome.err, Catch::Contains(said));
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    CHECK(outcome.out.empty());
}

std::string seed_scenario(const std::string& name) { return CREDENCE_SOURCE "/experiments/seed/" + name + ".ini"; }

}  // namespace credence::test
