#pragma once
// Conversion of numbers to bytes and back, for the journal. Little-endian, as every machine is that credence runs on.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace credence {

static_assert(std::endian::native == std::endian::little, "files hold little-endian numbers");

/// Appends to a string of bytes.
class ByteWriter {
public:
    template <class T>
    void put(T value) {
        static_assert(std::is_arithmetic_v<T>);
        put_raw(&value, sizeof value);
    }
    template <class T>
    void put_all(const std::vector<T>& values) {
        put_raw(values.data(), values.size() * sizeof(T));
    }
    /// Seven bits a byte, the lowest first; the eighth says that more follow [DWARF's LEB128].
    void put_count(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) put(static_cast<std::uint8_t>(value | 0x80));
        put(static_cast<std::uint8_t>(value));
    }
    void put_text(const std::string& text) {
        put_count(text.size());
        bytes_ += text;
    }
    void put_raw(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
    /// Writes over a number that was put at `position`.
    template <class T>
    void set(std::size_t position, T value) {
        std::memcpy(bytes_.data() + position, &value, sizeof value);
    }

    /// Reserves capacity for so many further bytes.
    void reserve(std::size_t further) {
        const std::size_t size = bytes_.size() + further;
        if (size > bytes_.capacity()) bytes_.reserve(std::max(size, 2 * bytes_.capacity()));
    }

    const std::string& bytes() const { return bytes_; }
    std::size_t size() const { return bytes_.size(); }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

/// Bytes with invalid content.
struct BadBytes : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reads untrusted bytes: it never reads beyond their end. Throws BadBytes.
class ByteReader {
public:
    ByteReader(const void* bytes, std::size_t size) : at_(static_cast<const char*>(bytes)), left_(size) {}

    template <class T>
    T get() {
        T value;
        std::memcpy(&value, raw(sizeof value), sizeof value);
        return value;
    }
    template <class T>
    std::vector<T> get_all(std::size_t count) {
        if (count > left_ / sizeof(T)) throw BadBytes("ends too early");
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), raw(count * sizeof(T)), count * sizeof(T));
        return values;
    }
    std::uint64_t get_count() {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 64; shift += 7) {
            const auto byte = get<std::uint8_t>();
            value |= std::uint64_t{byte & 0x7fu} << shift;
            if (byte < 0x80) return value;
        }
        throw BadBytes("a count is too large");
    }
    std::string get_text() {
        const std::uint64_t size = get_count();
        return {raw(size), size};
    }
    const char* raw(std::uint64_t size) {
        if (size > left_) throw BadBytes("ends too early");
        const char* here = at_;
        at_ += size;
        left_ -= static_cast<std::size_t>(size);
        return here;
    }
    std::size_t left() const { return left_; }

private:
    const char* at_;
    std::size_t left_;
};

}  // namespace credence
