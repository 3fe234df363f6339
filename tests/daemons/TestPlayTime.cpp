#include "daemons/velodynelogger/PlayTime.h"

#include <QTest>
#include <cstring>
#include <new>

using namespace hermes;
using namespace hermes::velodynelogger;

class TestPlayTime : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void longStepsAreAClockThatWasSet_data();
    void longStepsAreAClockThatWasSet();
};

namespace {
constexpr std::int64_t second_ns = 1000000000;
constexpr std::int64_t start_ns = 1700000000 * second_ns;

/// Through a pointer that the compiler cannot follow.
PlayTime *(*volatile begin)(void *, std::int64_t) = [](void *memory, std::int64_t length_ns) {
    return new (memory) PlayTime(start_ns, length_ns, 3 * second_ns);
};
} // namespace

void TestPlayTime::longStepsAreAClockThatWasSet_data() {
    const Rows<int, int, int> row("length_s", "step_s", "played_s");
    row("within a minute", 10, 60, 60);
    row("longer than a minute", 10, 61, 0);
    row("within a long recording", 600, 599, 599);
    row("longer than the recording", 600, 601, 0);
    row("back", 600, -1, 0);
}

void TestPlayTime::longStepsAreAClockThatWasSet() {
    FETCH(int, length_s, int, step_s, int, played_s);
    for (const int before : {0x00, 0x7f, 0xff}) { // whatever lay there must not matter
        alignas(PlayTime) unsigned char memory[sizeof(PlayTime)];
        std::memset(memory, before, sizeof memory);
        PlayTime &time = *begin(memory, length_s * second_ns);
        QCOMPARE(time.now_ns(), 3 * second_ns);
        QCOMPARE(time.advance(start_ns + step_s * second_ns), (3 + played_s) * second_ns);
    }
}

QTEST_APPLESS_MAIN(TestPlayTime)
#include "TestPlayTime.moc"
