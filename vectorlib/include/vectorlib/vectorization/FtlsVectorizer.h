#pragma once

#include "vectorlib/vectorization/Polyline.h"

#include <vector>

namespace vectorlib {

/// Fast total least squares vectorization: the longest intervals of points within sigma of their line, found
/// by binary search over prefix sums. Thesis 6.3. The points are one continuous cluster in scanning order,
/// all finite. Fewer than two points give no line. Every point belongs to exactly one line; every line has at
/// least two points. Keeps its buffers between calls.
template <typename Scalar = float>
class FtlsVectorizer {
public:
    VectorizerSettings settings;

    const std::vector<VectorizedLine> &operator()(PointSpan<Scalar> points) {
        m_lines.clear();
        const std::size_t count = points.size();
        if (count < 2)
            return m_lines;
        m_sums.assign(points);
        const double variance = settings.sigma * settings.sigma;
        m_cuts.assign(1, 0);
        while (m_cuts.back() < count)
            m_cuts.push_back(longest(m_cuts.back(), count, variance));
        giveLastLineTwoPoints(variance);
        for (std::size_t i = 0; i + 1 < m_cuts.size(); ++i)
            m_lines.push_back(
                makeLine(points, m_cuts[i], m_cuts[i + 1] - 1, m_sums.sums(m_cuts[i], m_cuts[i + 1])));
        if (settings.polyline)
            m_join(points, m_sums, settings, m_lines);
        return m_lines;
    }

    /// The prefix sums of the last cluster, for those who refine its lines.
    const PrefixSums &sums() const { return m_sums; }

private:
    // The end of the line that begins at `first`: figure 6.5. Two points always fit, so the search cannot
    // fail.
    std::size_t longest(std::size_t first, std::size_t count, double variance) const {
        if (m_sums.fitWithin(first, count, variance))
            return count;
        std::size_t good = std::min(first + 2, count), bad = count;
        while (bad - good > 1) {
            const std::size_t middle = good + (bad - good) / 2;
            (m_sums.fitWithin(first, middle, variance) ? good : bad) = middle;
        }
        return good;
    }
    // A single point left at the end has no line: it joins the line before, or takes a point from it.
    void giveLastLineTwoPoints(double variance) {
        const std::size_t cuts = m_cuts.size();
        if (cuts < 3 || m_cuts[cuts - 1] - m_cuts[cuts - 2] != 1)
            return;
        const std::size_t before = m_cuts[cuts - 3];
        if (m_cuts[cuts - 2] - before == 2 || m_sums.fitWithin(before, m_cuts[cuts - 1], variance))
            m_cuts.erase(m_cuts.end() - 2);
        else
            --m_cuts[cuts - 2];
    }

    PrefixSums m_sums;
    std::vector<std::size_t> m_cuts; // where lines begin; the last is the number of points
    std::vector<VectorizedLine> m_lines;
    PolylineJoiner m_join;
};

} // namespace vectorlib
