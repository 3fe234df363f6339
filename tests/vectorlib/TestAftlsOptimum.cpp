#include "Vectorizers.h"

#include <vectorlib/vectorization/OptimalVectorizer.h>

using namespace vectorlib;

/// AFTLS against the exact optimum in a thousand random closed rooms. Long.
class TestAftlsOptimum : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void withinOnePercent_data() {
        const Rows<int> row("rays");
        row("360 rays", 360);
        row("720 rays", 720);
        row("2000 rays", 2000);
    }
    void withinOnePercent() {
        QFETCH(int, rays);
        AftlsVectorizer<double> aftls, simplex;
        OptimalVectorizer<double> optimal;
        simplex.search = AftlsVectorizer<double>::Search::NelderMead;
        aftls.settings.polyline = simplex.settings.polyline = optimal.settings.polyline = false;
        const int rooms = 1000;
        int near = 0, simplexNear = 0;
        double worst = 1;
        for (std::uint64_t seed = 1; seed <= rooms; ++seed) {
            const auto points = roomScan(seed, rays);
            const double error = errorOf(aftls(points));
            optimal.lines = aftls(points).size();
            optimal(points);
            near += error <= 1.01 * optimal.error();
            simplexNear += errorOf(simplex(points)) <= 1.01 * optimal.error();
            worst = std::max(worst, error / optimal.error());
        }
        qInfo("within 1 %% of the optimum: %d of %d rooms (worst %.3f), by Nelder-Mead %d", near, rooms,
              worst, simplexNear);
        QVERIFY(near >= 0.95 * rooms);
    }
};
