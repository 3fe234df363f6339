#include "common/Time.h"
#include "common/Turns.h"

#include <QEventLoop>
#include <list>

using namespace hermes;

static void spend(double duration_s) {
    const double end = monotonicNow() + duration_s;
    while (monotonicNow() < end) {
    }
}

class TestTurns : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void stepsOfAnOwnerKeepTheirOrder_data() { rowsOfSeeds<unsigned>(1, 10); }

    // Steps come while others wait and run, before and after the time in which an owner counts as rested.
    void stepsOfAnOwnerKeepTheirOrder() {
        QFETCH(unsigned, seed);
        std::mt19937 random(seed);
        const auto draw = [&](int most) { return std::uniform_int_distribution<>(0, most)(random); };
        constexpr int owners = 4, steps = 200;
        std::vector<QObject> all(owners);
        std::vector<std::vector<int>> done(owners);
        std::vector<int> added(owners);
        const auto addSome = [&] {
            for (int count = draw(5); count > 0; --count) {
                const int i = draw(owners - 1);
                if (added[i] == steps)
                    continue;
                const double duration_s = draw(3) == 0 ? draw(3) * 1e-3 : 0;
                Turns::ofThread().add(&all[i], [&done, i, number = added[i]++, duration_s] {
                    spend(duration_s);
                    done[i].push_back(number);
                    return false;
                });
            }
        };
        QTimer more;
        connect(&more, &QTimer::timeout, this, addSome);
        more.start(0);
        const auto isDone = [&] {
            return std::all_of(done.begin(), done.end(), [](const auto &of) { return of.size() == steps; });
        };
        QTRY_VERIFY_WITH_TIMEOUT(isDone(), 30000);
        for (const std::vector<int> &of : done)
            QVERIFY(std::is_sorted(of.begin(), of.end()));
    }

    void whoRestedWaitsForNoCrowd_data() {
        const Rows<QString, int, double> row("crowd", "number", "duration_s");
        row("steps are wanted again", "again", 200, 50e-6);
        row("steps add the next ones", "adds", 200, 50e-6);
        row("long steps add the next ones", "adds", 20, 3e-3);
        row("steps add newcomers", "newcomers", 200, 50e-6);
    }

    void whoRestedWaitsForNoCrowd() {
        FETCH(QString, crowd, int, number, double, duration_s);
        std::list<QObject> owners(static_cast<std::size_t>(number));
        int stepsOfCrowd = 0;
        std::function<bool(QObject *)> step = [&](QObject *one) {
            spend(duration_s);
            ++stepsOfCrowd;
            QObject *const next = crowd == "newcomers" ? &owners.emplace_back() : one;
            if (crowd != "again")
                Turns::ofThread().add(next, [&step, next] { return step(next); });
            return crowd == "again";
        };
        for (QObject &one : owners)
            Turns::ofThread().add(&one, [&step, owner = &one] { return step(owner); });
        QTRY_VERIFY(stepsOfCrowd > 2 * number); // nobody of them has rested any more
        QObject rested;
        bool isKnown = false;
        Turns::ofThread().add(&rested, [&isKnown] {
            isKnown = true;
            return false;
        });
        QTRY_VERIFY(isKnown);
        spend(3e-3);
        int before = -1;
        const int now = stepsOfCrowd;
        Turns::ofThread().add(&rested, [&] {
            before = stepsOfCrowd - now;
            return false;
        });
        QTRY_VERIFY(before >= 0);
        QVERIFY2(before <= 1, saying(before));
    }

    void aStepMayWaitForALaterOne() {
        QObject owner;
        QEventLoop loop;
        bool isDone = false;
        Turns::ofThread().add(&owner, [&] {
            loop.exec();
            isDone = true;
            return false;
        });
        Turns::ofThread().add(&owner, [&] {
            loop.quit();
            return false;
        });
        QTRY_VERIFY(isDone);
    }

    void whoIsGoneHasNoSteps() {
        auto gone = std::make_unique<QObject>();
        QObject other;
        int ofGone = 0, ofOther = 0;
        for (int i = 0; i < 3; ++i) {
            Turns::ofThread().add(gone.get(), [&] { return ++ofGone > 0; });
            Turns::ofThread().add(&other, [&] { return ++ofOther < 10; });
        }
        gone.reset();
        QTRY_VERIFY(ofOther >= 12);
        QCOMPARE(ofGone, 0);
    }
};
