#include "cli/command.hpp"

#include "build_info.hpp"  // made by CMake

#include "study/releases.hpp"
#include "worlds/simulate.hpp"

#include <Eigen/Core>
#include <boost/version.hpp>
#include <hdf5.h>

#include <fstream>

namespace credence::cli {

namespace {

std::string processor() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

std::string libraries() {
    unsigned major = 0, minor = 0, release = 0;
    H5get_libversion(&major, &minor, &release);
    return "HDF5 " + std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release) + ", Eigen " +
           std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
           std::to_string(EIGEN_MINOR_VERSION) + ", Boost " + std::to_string(BOOST_VERSION / 100000) + "." +
           std::to_string(BOOST_VERSION / 100 % 1000);
}

}  // namespace

RunFacts build_facts() {
    return {{"credence_version", build_info::version}, {"git_revision", build_info::git_revision},
            {"compiler", build_info::compiler},        {"flags", build_info::flags},
            {"libraries", libraries()},                {"processor", processor()},
            {"instruction_set", best_target().name},     {"lane_width", std::to_string(best_target().lanes)}};
}

std::string made_by() { return release_name(build_info::version, build_info::git_revision); }

std::string version_text() {
    std::string text = "credence " + std::string(build_info::version) + "\n";
    for (const auto& [name, value] : build_facts())
        if (name != "credence_version") text += "  " + name + ": " + value + "\n";
    return text + "  schema_version: " + std::to_string(schema_version) + "\n";
}

}  // namespace credence::cli
