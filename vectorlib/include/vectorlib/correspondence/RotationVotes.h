#pragma once

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// A histogram of the rotations that pairs of segments ask for; its peaks are the rotations worth trying.
class RotationVotes {
public:
    /// Begins anew for rotations of at most `limit`; radians.
    void start(double limit) {
        m_half = static_cast<int>(limit / bin) + 2;
        m_votes.assign(static_cast<std::size_t>(2 * m_half + 1), 0.0);
    }
    void add(double alpha, double weight) {
        const int i = static_cast<int>(std::lround(alpha / bin)) + m_half;
        if (i > 0 && i + 1 < static_cast<int>(m_votes.size())) {
            m_votes[static_cast<std::size_t>(i - 1)] += weight;
            m_votes[static_cast<std::size_t>(i)] += 2 * weight;
            m_votes[static_cast<std::size_t>(i + 1)] += weight;
        }
    }
    /// The strongest rotations, best first, at most `count` and none next to a better one; radians.
    const std::vector<double> &peaks(int count) {
        m_peaks.clear();
        for (int k = 0; k < count; ++k) {
            const auto top = std::max_element(m_votes.begin(), m_votes.end());
            if (top == m_votes.end() || *top <= 0)
                break;
            const auto i = top - m_votes.begin(), last = static_cast<std::ptrdiff_t>(m_votes.size()) - 1;
            m_peaks.push_back(static_cast<double>(i - m_half) * bin);
            for (auto j = std::max<std::ptrdiff_t>(0, i - 2); j <= std::min(last, i + 2); ++j)
                m_votes[static_cast<std::size_t>(j)] = 0;
        }
        return m_peaks;
    }

private:
    static constexpr double bin = pi / 90; // 2 degrees
    int m_half = 0;
    std::vector<double> m_votes;
    std::vector<double> m_peaks;
};

} // namespace vectorlib
