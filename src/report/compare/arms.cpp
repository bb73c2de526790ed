// Parses `--arms A,B`.

#include <algorithm>
#include <credence/error.hpp>
#include <credence/text.hpp>
#include <filesystem>

#include "base/wording.hpp"
#include "report/compare/choice.hpp"

namespace credence {

namespace {

InputError refused(const std::string& text, const std::string& why) {
    return invalid_value(as_option("arms"), text, why,
                         "Write " + as_option("arms", "A,B") +
                             ", such as greedy.ekf,fixed.ekf, or FILE:ARM for an arm of one of several files");
}

/// Parses `ARM` or `FILE:ARM`; an arm without a file is of the file `own`, and is refused where that is not given.
ArmChoice read_arm(const std::string& part, const std::string& text, const std::vector<std::string>& paths,
                   std::optional<std::size_t> own) {
    const std::size_t colon = part.rfind(':');
    if (colon == std::string::npos) {
        if (!own) throw refused(text, part + " does not say of which file it is");
        return {*own, part};
    }
    const std::string name = trimmed(part.substr(0, colon)), arm = trimmed(part.substr(colon + 1));
    if (name.empty() || arm.empty()) throw refused(text, "an empty name");
    const std::vector<std::string> labels = file_labels(paths);
    for (std::size_t file = 0; file < paths.size(); ++file)
        if (name == paths[file] || name == labels[file]) return {file, arm};
    throw invalid_value(as_option("arms"), text, name + " is not one of the files", "The files are " + joined(labels));
}

}  // namespace

std::vector<std::string> file_labels(const std::vector<std::string>& paths) {
    std::vector<std::string> stems;
    for (const std::string& path : paths) stems.push_back(std::filesystem::path(path).stem().string());
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < paths.size(); ++i)
        labels.push_back(printable(std::count(stems.begin(), stems.end(), stems[i]) == 1 ? stems[i] : paths[i]));
    return labels;
}

ArmsChoice read_arms(const std::string& text, const std::vector<std::string>& paths) {
    const std::vector<std::string> parts = split_list(text);
    if (parts.size() != 2) throw refused(text, "not two arms with a comma between them");
    if (parts[0].empty() || parts[1].empty()) throw refused(text, "an empty name");
    // An arm without a file is of the first file or, of two files with both arms given so, B is of the second.
    const bool alone = parts[0].find(':') == std::string::npos && parts[1].find(':') == std::string::npos;
    std::optional<std::size_t> own_a, own_b;
    if (paths.size() == 1)
        own_a = own_b = 0;
    else if (paths.size() == 2 && alone)
        own_a = 0, own_b = 1;
    ArmsChoice choice{text, read_arm(parts[0], text, paths, own_a), read_arm(parts[1], text, paths, own_b)};
    for (std::size_t file = 0; file < paths.size(); ++file)
        if (file != choice.a.file && file != choice.b.file)
            throw invalid_value(as_option("arms"), text, paths[file] + " takes no part", "Leave that file out");
    return choice;
}

}  // namespace credence
