#pragma once
// Errors of what a file or arrays hold, which name the place and the remedy.

#include <credence/error.hpp>

#include <string>
#include <vector>

namespace credence {

/// An error of the content at a place in it; its remedy is empty where only the usual one helps. Who opened the file
/// translates it to an InputError or a Failure.
class PlacedError : public ComplaintError {
public:
    PlacedError(const std::string& place, const std::string& problem, const std::string& remedy = {})
        : ComplaintError(Complaint{problem, {}, remedy, {}, place}) {}
};

/// Extents in messages: `[3, 2]`
template <class Number>
std::string extents_text(const std::vector<Number>& extents) {
    std::string text;
    for (const Number extent : extents) text += (text.empty() ? "[" : ", ") + std::to_string(extent);
    return text + "]";
}

}  // namespace credence
