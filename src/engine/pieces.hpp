#pragma once
// The memory of a trial, laid out in pieces.

#include <credence/detail/real.hpp>

#include <cstddef>

namespace credence {
inline namespace CREDENCE_TARGET {

/// A number of bytes up to the next boundary of 64.
constexpr std::size_t padded(std::size_t bytes) { return (bytes + 63) / 64 * 64; }

/// Memory one piece after the other, each from a 64-byte boundary on; without a start it only counts.
class Pieces {
public:
    explicit Pieces(std::byte* start = nullptr) : start_(start) {}
    template <class T>
    T* take(std::size_t count) {
        const std::size_t at = size_;
        size_ += padded(count * sizeof(T));
        return start_ == nullptr ? nullptr : reinterpret_cast<T*>(start_ + at);
    }
    std::size_t size() const { return size_; }

private:
    std::byte* start_;
    std::size_t size_ = 0;
};

}  // namespace CREDENCE_TARGET
}  // namespace credence
