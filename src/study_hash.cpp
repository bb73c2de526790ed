#include <credence/scenario_keys.hpp>
#include <credence/study.hpp>

#include <boost/uuid/name_generator.hpp>
#include <boost/uuid/uuid_io.hpp>

namespace credence {

std::string study_hash(const Study& study) {
    std::string text = "schema " + std::to_string(schema_version) + "\nroot_seed " + std::to_string(study.root_seed) +
                       "\nkeep trials\n";
    for (const ScenarioResults& results : study.scenarios) text += "\n" + scenario_text(results.scenario);
    const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
    return boost::uuids::to_string(generate(text));
}

}  // namespace credence
