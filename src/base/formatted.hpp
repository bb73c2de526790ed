#pragma once
// printf into a string.

#include <locale.h>

#include <cstdarg>
#include <cstdio>
#include <string>

namespace credence {

/// What printf writes in the C locale, up to 500 characters: that of a process, such as Python's, may have decimal
/// commas.
[[gnu::format(printf, 1, 2)]] inline std::string formatted(const char* format, ...) {
    static const locale_t classic = newlocale(LC_ALL_MASK, "C", nullptr);
    const locale_t before = uselocale(classic);
    char text[501];
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    uselocale(before);
    return text;
}

}  // namespace credence
