#include "RandomPairs.h"

#include <vectorlib/correspondence/PotentialPairs.h>
#include <vectorlib/registration/LineSegmentRegistration.h>
#include <vectorlib/registration/PointRefinement.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;

static Segment direction(double degrees) {
    const double a = degrees * pi / 180;
    return {{1, 1}, {1 + std::cos(a), 1 + std::sin(a)}};
}

class TestRegistration : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void noiseFreeSetsComeBack_data() {
        const Rows<int> row("rotation");
        row("mitsuta", int(Rotation::Mitsuta));
        row("wahba", int(Rotation::Wahba));
    }

    void noiseFreeSetsComeBack() { // errata 6 and 7
        QFETCH(int, rotation);
        std::mt19937 random(11);
        std::uniform_real_distribution<double> t(-3, 3), a(-pi, pi);
        for (int i = 0; i < 10000; ++i) {
            const Transformation2D truth(t(random), t(random), a(random));
            LineSegmentRegistration registration;
            registration.rotation = Rotation(rotation);
            const std::vector<SegmentPair> pairs = randomPairs(truth, 2 + i % 199, random);
            QCOMPARE(registration.add(pairs), pairs.size());
            const double e = difference(registration.transformation(), truth);
            QVERIFY2(e < 1e-9, saying("case %1, %2 pairs, reliability %3: %4", i, pairs.size(),
                                      registration.reliability(), e));
            QVERIFY(registration.ambiguity().total() < 1e-12 * (1 + registration.weight()));
        }
    }

    // Errata 6 and 7: with the printed signs the same sets do not come back.
    void printedSignsGiveAnotherTransformation() {
        std::mt19937 random(12);
        const Transformation2D truth(0.8, -0.5, 0.4);
        double px = 0, py = 0, xx = 0, xy = 0, yy = 0;
        for (const SegmentPair &p : randomPairs(truth, 20, random)) {
            const Vector2D<double> v = p.fixed.direction(), n = p.fixed.normal();
            const double shift = p.fixed.begin().dot(n) - p.moving.begin().dot(p.moving.normal());
            px += shift * n.x, py += shift * n.y;
            xx += v.x * v.x, xy += v.x * v.y, yy += v.y * v.y;
        }
        const double d = xx * yy - xy * xy;
        const Vector2D<double> corrected((px * xx + xy * py) / d, (py * yy + xy * px) / d);
        const Vector2D<double> printed((px * xx - xy * py) / d, (py * yy - xy * px) / d);
        QVERIFY((corrected - truth.translation()).norm() < 1e-9);
        QVERIFY((printed - truth.translation()).norm() > 0.1);    // erratum 7
        QVERIFY((-corrected - truth.translation()).norm() > 0.1); // erratum 6: the inverse shift
    }

    void equalAnglesAverageToThemselves() { // erratum 8: three times 10 degrees
        LineSegmentRegistration registration;
        for (double d : {0.0, 60.0, 140.0})
            registration.add(direction(d + 10), direction(d));
        QVERIFY(std::abs(registration.transformation().alpha() * 180 / pi - 10) < 1e-9);
        // As printed, the sums take the differences: 10 + 0 + 0 over 3.
        double sum = 10 * pi / 180, old = sum;
        for (int i = 1; i < 3; ++i)
            sum += 10 * pi / 180 - old;
        QVERIFY(std::abs(sum / 3 * 180 / pi - 10) > 6);
    }

    void anglesAcrossPi() {
        for (Rotation rotation : {Rotation::Mitsuta, Rotation::Wahba}) {
            LineSegmentRegistration registration;
            registration.rotation = rotation;
            registration.add(direction(175), direction(0));
            registration.add(direction(-175 + 90), direction(90));
            QVERIFY(std::abs(std::abs(registration.transformation().alpha()) - pi) < 1e-9);
        }
    }

    void mitsutaAndWahbaOnThePaperExample() { // paper 4.5: 0, 0, 90 degrees
        LineSegmentRegistration registration;
        for (double d : {0.0, 0.0, 90.0})
            registration.add(direction(d), direction(0));
        QVERIFY(std::abs(registration.transformation().alpha() * 180 / pi - 30) < 1e-9);
        registration.rotation = Rotation::Wahba;
        QVERIFY(std::abs(registration.transformation().alpha() * 180 / pi - 26.56505) < 1e-4);
    }

    void addRemoveAndMerge() {
        std::mt19937 random(13);
        const auto pairs = randomPairs({0.3, 0.2, 3.1}, 30, random),
                   others = randomPairs({-1, 0.2, -3.1}, 30, random);
        LineSegmentRegistration whole, part, extra;
        for (std::size_t i = 0; i < 30; ++i) {
            whole.add(pairs[i].fixed, pairs[i].moving, 0.1 + double(i));
            (i < 12 ? part : extra).add(pairs[i].fixed, pairs[i].moving, 0.1 + double(i));
        }
        part.add(extra);
        QCOMPARE(part.pairs(), 30);
        QVERIFY(difference(part.transformation(), whole.transformation()) < 1e-9);
        QVERIFY(std::abs(part.ambiguity().total() - whole.ambiguity().total()) < 1e-6);
        for (std::size_t i = 0; i < 30; ++i)
            part.add(others[i].fixed, others[i].moving, 2);
        QVERIFY(difference(part.transformation(), whole.transformation()) > 0.1);
        for (std::size_t i = 30; i-- > 0;)
            part.remove(others[i].fixed, others[i].moving, 2);
        QVERIFY(difference(part.transformation(), whole.transformation()) < 1e-9);
        part.remove(whole);
        QCOMPARE(part.pairs(), 0);
        QCOMPARE(part.reliability(), 0.0);
    }

    void weightsArePulls() {
        LineSegmentRegistration registration;
        registration.add(Segment({0, 0}, {5, 0}), Segment({0, 0}, {5, 0}), 3); // wants y = 0
        registration.add(Segment({0, 1}, {5, 1}), Segment({0, 0}, {5, 0}), 1); // wants y = 1
        registration.add(Segment({0, 0}, {0, 5}), Segment({0, 0}, {0, 5}), 1);
        QVERIFY(std::abs(registration.transformation().y() - 0.25) < 1e-12);
    }

    void reliabilityOfKnownSets() { // erratum 9: 2 sqrt(det E), eigenvalues of E sum to 1
        LineSegmentRegistration registration;
        registration.add(direction(20), direction(20));
        QCOMPARE(registration.reliability(), 0.0);
        registration.add(direction(110), direction(110));
        QVERIFY(std::abs(registration.reliability() - 1) < 1e-12);
        LineSegmentRegistration
            skew; // two lines at the angle gamma: sin(gamma); sqrt(det E) as printed gives half of it
        skew.add(direction(0), direction(0));
        skew.add(direction(30), direction(30));
        QVERIFY(std::abs(skew.reliability() - 0.5) < 1e-12);
        for (int degrees = 0; degrees < 360; ++degrees) { // never above 1 by rounding
            LineSegmentRegistration even;
            even.add(direction(degrees), direction(0), 0.1);
            even.add(direction(degrees + 90), direction(90), 0.1);
            QVERIFY(even.reliability() <= 1 && even.reliability() > 1 - 1e-9);
        }
    }

    void collinearSetsAreReported() {
        LineSegmentRegistration registration;
        QCOMPARE(registration.reliability(), 0.0);
        QVERIFY(!registration.isSolvable());
        for (int i = 0; i < 5; ++i)
            registration.add(Segment({0, 1.0 * i}, {4, 1.0 * i}),
                             Segment({0, 1.0 * i - 0.5}, {4, 1.0 * i - 0.5}));
        QVERIFY(!registration.isSolvable());
        QCOMPARE(registration.reliability(), 0.0);
        const Transformation2D t = registration.transformation();
        QVERIFY(t.isFinite());
        QVERIFY(std::abs(t.x()) < 1e-12 && std::abs(t.y() - 0.5) < 1e-12); // across the lines it is known
    }

    void ambiguityAgreesAtTheOptimum() { // erratum 10
        std::mt19937 random(14);
        std::normal_distribution<double> noise(0, 0.05);
        for (Rotation rotation : {Rotation::Mitsuta, Rotation::Wahba}) {
            LineSegmentRegistration registration;
            registration.rotation = rotation;
            for (const SegmentPair &p : randomPairs({0.3, 0.2, 0.5}, 30, random))
                registration.add(p.fixed,
                                 Transformation2D(noise(random), noise(random), noise(random)) * p.moving);
            const double best = registration.ambiguity().total();
            QVERIFY(best > 1e-4);
            const Transformation2D optimum = registration.transformation();
            QVERIFY(std::abs(registration.ambiguity(optimum).total() - best) < 1e-9);
            for (const Transformation2D &away : {Transformation2D(0.01, 0, 0), Transformation2D(0, -0.01, 0)})
                QVERIFY(registration.ambiguity(away * optimum).total() > best);
        }
    }

    // Erratum 10: paper (19) at another transformation than the optimum even goes below zero; the full
    // expansion does not.
    void printedAmbiguityIsWrongElsewhere() {
        LineSegmentRegistration registration;
        registration.add(Segment({0, 0}, {1, 0}), Segment({0, 0}, {1, 0}));
        registration.add(Segment({0, 0}, {0, 1}), Segment({0, 0}, {0, 1}));
        const double tx = 2, ty = 1; // exact answer: each line is off by its own distance
        const double printed = 0 - tx * tx * 1 + 2 * tx * ty * 0 - ty * ty * 1;
        QCOMPARE(printed, -5.0);
        QVERIFY(std::abs(registration.ambiguity({tx, ty, 0}).total() - 5) < 1e-12);
    }

    void ambiguityOfKnownCompromise() {
        LineSegmentRegistration registration;
        registration.add(Segment({0, 0}, {5, 0}), Segment({0, 0}, {5, 0}));
        registration.add(Segment({0, 0.2}, {5, 0.2}), Segment({0, 0}, {5, 0}));
        registration.add(Segment({0, 0}, {0, 5}), Segment({0, 0}, {0, 5}));
        QVERIFY(std::abs(registration.ambiguity().xy - 2 * 0.1 * 0.1) < 1e-12); // both miss by 0.1 m
        QCOMPARE(registration.ambiguity().alpha, 0.0);
    }

    void stiffnessOfNothingIsNoAmbiguity() {
        LineSegmentRegistration registration;
        registration.add(direction(0), direction(0));
        registration.add(direction(90), direction(50));
        QVERIFY(registration.ambiguity().total() > 0.01);
        registration.stiffness = {0, 0};
        QCOMPARE(registration.ambiguity().total(), 0.0);
        QCOMPARE(registration.ambiguity({1, 2, 3}).total(), 0.0);
    }

    // Two lines at a hundred-thousandth of a radian, in any direction: the sums of plain x and y would leave
    // no digit of it.
    void nearlyParallelLinesKeepTheirDigits() {
        const Transformation2D truth(0.3, -0.2, 0.4);
        for (double degrees = 0; degrees < 360; degrees += 7) {
            LineSegmentRegistration registration;
            for (const Segment &seen : {direction(degrees), direction(degrees + 180 / pi * 1e-5)})
                registration.add(truth * seen, seen);
            QVERIFY(registration.isSolvable());
            QVERIFY(std::abs(registration.reliability() - 1e-5) < 1e-9);
            QVERIFY2(difference(registration.transformation(), truth) < 1e-9,
                     saying(difference(registration.transformation(), truth)));
        }
    }

    void refusesUnusablePairs() {
        LineSegmentRegistration registration;
        const Segment good({0, 0}, {1, 0}), point({1, 1}, {1, 1}), nan({0, 0}, {qQNaN(), 1}),
            huge({0, 1e200}, {1, 1e200});
        QVERIFY(!registration.add(good, point));
        QVERIFY(!registration.add(point, good));
        QVERIFY(!registration.add(nan, good));
        QVERIFY(!registration.add(good, nan));
        QVERIFY(!registration.add(huge, good));
        for (double weight : {0.0, -1.0, qInf(), qQNaN()})
            QVERIFY(!registration.add(good, good, weight));
        QCOMPARE(
            registration.add(std::vector<SegmentPair>{{good, point, 1}, {good, good, 1}, {nan, good, 1}}),
            std::size_t(1));
        registration.clear();
        QCOMPARE(registration.pairs(), 0);
        QVERIFY(!registration.isSolvable());
        QCOMPARE(registration.reliability(), 0.0);
        QCOMPARE(registration.ambiguity().total(), 0.0);
        QCOMPARE(registration.ambiguity({1, 2, 3}).total(), 0.0);
        QVERIFY(difference(registration.transformation(), {}) == 0);
    }

    void removesOnlyWhatCanBeThere() {
        LineSegmentRegistration none, one;
        one.add(direction(10), direction(0));
        QVERIFY(!none.remove(direction(10), direction(0)));
        QVERIFY(!none.remove(one));
        QVERIFY(!one.remove(direction(10), Segment({1, 1}, {1, 1})));
        QCOMPARE(one.pairs(), 1);
        one.add(one);
        QCOMPARE(one.pairs(), 2);
        QVERIFY(std::abs(one.transformation().alpha() * 180 / pi - 10) < 1e-9);
        QVERIFY(one.remove(one));
        QCOMPARE(one.pairs(), 0);
    }

    // Erratum 5: the squared distance of x from the line P + tau v is |x-P|^2 - ((x-P).v)^2; the printed form
    // lacks a square.
    void squaredDistanceInTransformationSpace() {
        const Segment fixed({1, 2}, {4, 6});
        LineSegmentRegistration registration;
        registration.add(fixed, Segment({0, 0}, {3, 4}));
        const Vector2D<double> n = fixed.normal(), v = fixed.direction(), p = n * fixed.begin().dot(n);
        const Vector2D<double> x(2.5, -1.4), d = x - p;
        const double corrected = d.squaredNorm() - d.dot(v) * d.dot(v), printed = d.squaredNorm() - d.dot(v);
        QVERIFY(std::abs(registration.ambiguity({x.x, x.y, 0}).xy - corrected) < 1e-12);
        QVERIFY(std::abs(printed - corrected) > 0.1);
    }

    // Erratum 13: the same small turn of each segment costs far more translation when the frame's origin is
    // far away.
    void farFromTheOriginRotationCouples() {
        const auto shiftError = [](double offset) {
            LineSegmentRegistration registration;
            const Transformation2D place(offset, offset, 0);
            for (int i = 0; i < 8; ++i) {
                const Segment fixed =
                    place * Segment({std::cos(i), std::sin(i)}, {2 * std::cos(i + 0.7), std::sin(i)});
                const Vector2D<double> middle = fixed.middle();
                const Transformation2D wobble = Transformation2D(middle.x, middle.y, i % 2 ? 0.01 : -0.01) *
                                                Transformation2D(-middle.x, -middle.y, 0);
                registration.add(fixed, wobble * fixed);
            }
            return registration.transformation().translation().norm();
        };
        QVERIFY(shiftError(0) < 0.05);
        QVERIFY(shiftError(1000) > 10 * shiftError(0));
    }

    void pointToLineStepUsesTheSums() {
        const Transformation2D truth(0.05, -0.03, 0.02);
        PointToLineRefinement refinement;
        Transformation2D found;
        for (int i = 0; i < 5; ++i) {
            refinement.start(0, 0);
            for (const Segment &wall :
                 {Segment({2, -1}, {2, 3}), Segment({2, 3}, {-1, 3}), Segment({-1, 0}, {1, -2})}) {
                std::vector<Vector2D<double>> points;
                for (int k = 0; k <= 20; ++k)
                    points.push_back(truth.inverse() *
                                     (wall.begin() + (wall.end() - wall.begin()) * (k / 20.0)));
                refinement.add(wall, found * TlsSums::of(points.begin(), points.end()), 1);
            }
            found = refinement.step() * found;
        }
        QVERIFY(difference(found, truth) < 1e-9);
    }

    void mayCorrespond_data() {
        const Rows<QLineF, bool> row("moving", "possible");
        // The static one runs from (2, -1) to (2, 1); permitted are 0.5 m in x and y and 0.2 rad.
        row("itself", QLineF(2, -1, 2, 1), true);
        row("0.4 m apart", QLineF(1.6, -1, 1.6, 1), true);
        row("0.6 m apart", QLineF(1.4, -1, 1.4, 1), false);
        row("0.4 m beyond its end", QLineF(2, 1.4, 2, 3), true);
        row("0.6 m beyond its end", QLineF(2, 1.6, 2, 3), false);
        row("seen from behind", QLineF(2, 1, 2, -1), false);
        row("turned by 0.15", QLineF(2, -1, 2 - std::sin(0.15), -1 + std::cos(0.15)), true);
        row("turned by 0.3", QLineF(2, -1, 2 - std::sin(0.3), -1 + std::cos(0.3)), false);
    }

    void mayCorrespond() {
        FETCH(QLineF, moving, bool, possible);
        const Segment fixed({2, -1}, {2, 1}), seen({moving.x1(), moving.y1()}, {moving.x2(), moving.y2()});
        QCOMPARE(vectorlib::mayCorrespond(fixed, seen, {0.5, 0.5, 0.2}), possible);
    }
};
