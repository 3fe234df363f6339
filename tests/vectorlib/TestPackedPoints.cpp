#include <vectorlib/geometry/PackedPoints.h>

using namespace vectorlib;

/// Points kept in half the memory.
class TestPackedPoints : public QObject {
    Q_OBJECT

    static std::vector<Vector2D<float>> kept(const std::vector<Vector2D<float>> &points) {
        std::vector<Vector2D<float>> result{{1, 1}}; // leaves with the first
        PackedPoints(points).unpack(result);
        return result;
    }

private Q_SLOTS:
    void pointsStayWhereTheyAre() {
        std::vector<Vector2D<float>> points;
        for (int i = 0; i < 1000; ++i)
            points.emplace_back(float(0.02 * i * std::cos(0.1 * i)), float(0.02 * i * std::sin(0.1 * i)));
        const std::vector<Vector2D<float>> found = kept(points);
        QCOMPARE(found.size(), points.size());
        constexpr float half = 0.5F * 20 / INT16_MAX * 1.01F; // of a step; metres
        for (std::size_t i = 0; i < points.size(); ++i) {
            QVERIFY(std::abs(found[i].x - points[i].x) <= half);
            QVERIFY(std::abs(found[i].y - points[i].y) <= half);
        }
    }
    void pointsThatCannotBeAreLeftOut() {
        const float nan = std::numeric_limits<float>::quiet_NaN(), far = 1e9F;
        const auto found = kept({{3, -4}, {nan, 1}, {1, nan}, {far, 0}, {0, -far}, {-300, 5}});
        QCOMPARE(found.size(), std::size_t(2));
        QVERIFY(std::abs(found[0].y + 4) < 0.005F);
        QVERIFY(std::abs(found[1].x + 300) < 0.005F);
    }
    void thereMayBeNoneOrAllInOnePlace() {
        QVERIFY(kept({}).empty());
        const auto found = kept({{0, 0}, {0, 0}});
        QCOMPARE(found.size(), std::size_t(2));
        QCOMPARE(found[1].x, 0.0F);
    }
};
