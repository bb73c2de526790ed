#pragma once
// Errors of what a file or arrays hold, which name the place and the remedy.

#include <stdexcept>
#include <string>
#include <utility>

namespace credence {

/// An error of the content, as `place: problem`. Who opened the file translates it to an InputError or a Failure.
class PlacedError : public std::runtime_error {
public:
    PlacedError(const std::string& place, const std::string& problem, std::string remedy = {})
        : std::runtime_error(place + ": " + problem), remedy_(std::move(remedy)) {}
    /// The remedy; empty where only the usual one helps.
    const std::string& remedy() const { return remedy_; }

private:
    std::string remedy_;
};

}  // namespace credence
