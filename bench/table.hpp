#pragma once
// Tables of measurements, as text and as JSON: the same data.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace credence::bench {

using Json = nlohmann::ordered_json;

struct Table {
    std::string key;  ///< name in the JSON
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<Json>> rows;  ///< texts, numbers and nulls
};

/// Columns lined up, numbers to four digits.
std::string text_of(const Table& table);

/// An array with an object per row.
Json json_of(const Table& table);

}  // namespace credence::bench
