#include <credence/detail/provenance.hpp>

#include <credence/study.hpp>
#include <credence/text.hpp>

#include <algorithm>
#include <stdexcept>

namespace credence {

namespace {

const std::string after_release = ": ";
constexpr std::size_t most_releases = 1000, longest_text = std::size_t{16} << 20;

std::string blocks_text(const BlockRanges& blocks) {
    std::string text;
    for (const BlockRange& range : blocks.ranges()) {
        text += " " + std::to_string(range.first);
        if (range.count() > 1) text += "-" + std::to_string(range.last);
    }
    return text;
}

std::int64_t read_block(const std::string& text) {
    const std::optional<std::int64_t> block = to_integer(text);
    if (!block || *block < 0 || *block >= most_trials) throw std::invalid_argument(text);
    return *block;
}

BlockRanges read_blocks(const std::vector<std::string>& texts) {
    BlockRanges blocks;
    for (const std::string& text : texts) {
        const std::size_t dash = text.find('-');
        const BlockRange range{read_block(text.substr(0, dash)),
                               read_block(dash == std::string::npos ? text : text.substr(dash + 1))};
        if (range.last < range.first || (!blocks.empty() && range.first <= blocks.back()))
            throw std::invalid_argument(text);
        blocks.add(range);
    }
    return blocks;
}

std::size_t scenario_of(const Study& study, const std::string& name) {
    const auto found = std::find_if(study.scenarios.begin(), study.scenarios.end(),
                                    [&](const ScenarioResults& results) { return results.scenario.name == name; });
    if (found == study.scenarios.end()) throw std::invalid_argument(name);
    return static_cast<std::size_t>(found - study.scenarios.begin());
}

/// The releases of the study's blocks, with those of unknown release as well.
Provenance all_of(const Study& study) {
    Provenance all;
    for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
        const BlockRanges& there = study.scenarios[s].blocks;
        note_computed(all, study.computed_by, s, there);
        BlockRanges left = there;
        for (const ComputedBy& one : all) left = left.without(one.of(s));
        if (!left.empty()) note_computed(all, unknown_release, s, left);
    }
    return all;
}

/// `credence 0.1.` of `credence 0.1.0, git revision 1a2b3c4`; empty where the version is not known.
std::string mixable_part(const std::string& release) {
    const std::size_t major = release.find('.');
    const std::size_t minor = major == std::string::npos ? major : release.find('.', major + 1);
    return minor == std::string::npos ? "" : release.substr(0, minor + 1);
}

}  // namespace

const BlockRanges& ComputedBy::of(std::size_t scenario) const {
    static const BlockRanges none;
    return scenario < blocks.size() ? blocks[scenario] : none;
}

std::string release_name(const std::string& version, const std::string& revision) {
    return "credence " + version + ", git revision " + revision;
}

void note_computed(Provenance& provenance, const std::string& release, std::size_t scenario,
                   const BlockRanges& blocks) {
    ComputedBy* own = nullptr;
    for (ComputedBy& one : provenance) {
        if (one.release == release) own = &one;
        else if (scenario < one.blocks.size()) one.blocks[scenario] = one.blocks[scenario].without(blocks);
    }
    if (own == nullptr) own = &provenance.emplace_back(ComputedBy{release, {}});
    if (own->blocks.size() <= scenario) own->blocks.resize(scenario + 1);
    own->blocks[scenario].add(blocks);
}

void note_computed(Provenance& provenance, const Provenance& source, std::size_t scenario, const BlockRanges& blocks) {
    for (const ComputedBy& one : source)
        if (const BlockRanges theirs = one.of(scenario).common(blocks); !theirs.empty())
            note_computed(provenance, one.release, scenario, theirs);
}

bool may_mix(const std::string& release, const std::string& other) {
    const std::string a = mixable_part(release), b = mixable_part(other);
    return a.empty() || b.empty() || a == b;
}

std::string unmixable(const Provenance& provenance, const std::string& release) {
    for (const ComputedBy& one : provenance)
        if (!may_mix(one.release, release)) return one.release;
    return {};
}

std::string why_unmixable(const std::string& other, const std::string& release) {
    return other + " computed trials of it, and this is " + release + "; draws and columns may differ between them";
}

std::string provenance_text(const Study& study) {
    if (study.computed_by.empty()) return {};
    const Provenance all = all_of(study);
    if (all.size() == 1) return all.front().release;
    std::vector<std::string> lines;
    for (const ComputedBy& one : all) {
        std::vector<std::string> scenarios;
        for (std::size_t s = 0; s < study.scenarios.size(); ++s)
            if (!one.of(s).empty()) scenarios.push_back(study.scenarios[s].scenario.name + blocks_text(one.of(s)));
        lines.push_back(one.release + after_release + joined(scenarios, "; "));
    }
    return joined(lines, "\n");
}

Provenance read_provenance(const std::string& text, const Study& study) {
    Provenance provenance;
    if (text.empty()) return provenance;
    if (text.size() > longest_text) throw std::invalid_argument("a list of releases that is too long");
    if (text.rfind(after_release) == std::string::npos) {
        for (std::size_t s = 0; s < study.scenarios.size(); ++s)
            note_computed(provenance, text, s, study.scenarios[s].blocks);
        return provenance;
    }
    const std::vector<std::string> lines = split_list(text, '\n');
    if (lines.size() > most_releases) throw std::invalid_argument(text);
    for (const std::string& line : lines) {
        const std::size_t end = line.rfind(after_release);
        if (end == std::string::npos) throw std::invalid_argument(line);
        for (const std::string& part : split_list(line.substr(end + after_release.size()), ';')) {
            std::vector<std::string> words = split_list(part, ' ');
            if (words.empty()) throw std::invalid_argument(line);
            const std::size_t s = scenario_of(study, words.front());
            words.erase(words.begin());
            note_computed(provenance, line.substr(0, end), s, read_blocks(words).common(study.scenarios[s].blocks));
        }
    }
    return provenance;
}

}  // namespace credence
