#include <credence/study.hpp>

#include <boost/uuid/name_generator.hpp>
#include <boost/uuid/uuid_io.hpp>

namespace credence {

StudyDefinition definition_of(const Study& study) {
    StudyDefinition definition{study.root_seed, {}, keep_of(study)};
    for (const ScenarioResults& results : study.scenarios) definition.scenarios.push_back(results.scenario);
    return definition;
}

std::string study_hash(const StudyDefinition& definition) {
    std::string text = "schema " + std::to_string(draws_version) + "\nroot_seed " +
                       std::to_string(definition.root_seed) + "\nkeep " + keep_name(definition.keep) + "\n";
    for (Scenario scenario : definition.scenarios) {
        std::erase_if(scenario.settings, [](const Setting& setting) { return setting.later_default; });
        text += "\n" + scenario_text(scenario);
    }
    const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
    return boost::uuids::to_string(generate(text));
}

std::string study_hash(const Study& study) { return study_hash(definition_of(study)); }

std::string difference_of(const StudyDefinition& there, const StudyDefinition& here) {
    if (study_hash(there) == study_hash(here)) return "";
    if (there.root_seed != here.root_seed)
        return "its root seed is " + std::to_string(there.root_seed) + ", not " + std::to_string(here.root_seed);
    if (there.keep != here.keep) return "it keeps " + keep_name(there.keep) + ", not " + keep_name(here.keep);
    if (there.scenarios.size() != here.scenarios.size())
        return "it has " + std::to_string(there.scenarios.size()) + " scenarios, not " +
               std::to_string(here.scenarios.size());
    for (std::size_t s = 0; s < there.scenarios.size(); ++s) {
        const std::vector<KeyDifference> differences = key_differences(there.scenarios[s], here.scenarios[s]);
        if (differences.empty()) continue;
        const KeyDifference& first = differences.front();
        return "scenario " + there.scenarios[s].name + ": " + first.key + " is " + first.a + " there and " + first.b +
               " here";
    }
    return "it has other scenarios";
}

}  // namespace credence
