#include "base/descriptor.hpp"

#include <unistd.h>

#include <cctype>
#include <system_error>

namespace credence {

Descriptor::~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::string words_for(int error) {
    std::string words = std::generic_category().message(error);
    if (!words.empty()) words.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(words.front())));
    return words;
}

}  // namespace credence
