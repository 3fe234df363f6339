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
        : m_data(data)
        , m_size(size) {}
    PointSpan(const std::vector<Vector2D<Scalar>> &points)
        : PointSpan(points.data(), points.size()) {}

    std::size_t size() const { return m_size; }
    bool empty() const { return m_size == 0; }
    const Vector2D<Scalar> &operator[](std::size_t i) const { return m_data[i]; }
    const Vector2D<Scalar> &front() const { return m_data[0]; }
    const Vector2D<Scalar> &back() const { return m_data[m_size - 1]; }
    const Vector2D<Scalar> *begin() const { return m_data; }
    const Vector2D<Scalar> *end() const { return m_data + m_size; }
    PointSpan part(std::size_t first, std::size_t count) const { return {m_data + first, count}; }

private:
    const Vector2D<Scalar> *m_data = nullptr;
    std::size_t m_size = 0;
};

} // namespace vectorlib
