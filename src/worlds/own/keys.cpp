#include <credence/detail/own_keys.hpp>

#include <credence/detail/draws.hpp>
#include <credence/text.hpp>

#include "worlds/values.hpp"

namespace credence {

const std::vector<KeyOf<OwnBasics>>& basic_keys() {
    static const std::vector<KeyOf<OwnBasics>> keys = [] {
        std::vector<KeyOf<OwnBasics>> common;
        add_common_keys(common);
        return common;
    }();
    return keys;
}

std::vector<DrawSource> own_sources(const std::vector<std::string>& names) {
    std::vector<DrawSource> sources;
    for (const std::string& name : names) {
        const auto source = static_cast<Source>(sources.size());
        sources.push_back({name, source_bit(source, 0) | source_bit(source, 1)});
    }
    return sources;
}

double own_real(const std::string& key, const std::string& text, double low, double high) {
    return parse_real(key, text, between(low, high));
}

int own_integer(const std::string& key, const std::string& text, int low, int high) {
    return static_cast<int>(parse_integer(key, text, low, high));
}

std::size_t own_choice(const std::string& key, const std::string& text, const std::vector<std::string>& choices) {
    return parse_choice(key, text, choices);
}

std::vector<double> own_reals(const std::string& key, const std::string& text, double low, double high) {
    std::vector<double> values = parse_reals(key, text, between(low, high));
    if (values.empty()) throw invalid_value(key, text, "it is empty", "Give at least one number");
    return values;
}

std::string own_text(double value) { return to_text(value); }

std::string own_text(const std::vector<double>& values) { return reals_text(values); }

}  // namespace credence
