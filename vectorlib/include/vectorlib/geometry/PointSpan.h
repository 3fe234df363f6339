#pragma once

#include "vectorlib/geometry/Vector2D.h"

#include <cstddef>
#include <vector>

namespace vectorlib {

/// Points in order of acquisition that somebody else owns: a pointer and a count.
template <typename Scalar>
class PointSpan {
public:
    PointSpan() = default;
    PointSpan(const Vector2D<Scalar> *data, std::size_t size)
        : data_(data)
        , size_(size) {}
    PointSpan(const std::vector<Vector2D<Scalar>> &points)
        : PointSpan(points.data(), points.size()) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const Vector2D<Scalar> &operator[](std::size_t i) const { return data_[i]; }
    const Vector2D<Scalar> &front() const { return data_[0]; }
    const Vector2D<Scalar> &back() const { return data_[size_ - 1]; }
    const Vector2D<Scalar> *begin() const { return data_; }
    const Vector2D<Scalar> *end() const { return data_ + size_; }
    /// The `count` points from number `first` on; all must be there.
    PointSpan part(std::size_t first, std::size_t count) const { return {data_ + first, count}; }

private:
    const Vector2D<Scalar> *data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace vectorlib
