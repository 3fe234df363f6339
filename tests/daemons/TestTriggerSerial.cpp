// What the software trigger does to a serial line: a pseudo-terminal. It has neither RTS nor DTR: what is
// tested is what the program asks of the system, ioctl() of this program, which hears it before the system
// does.
#include "TriggerFixture.h"

#include <cstdarg>
#include <pty.h>
#include <sys/syscall.h>

using namespace hermes;
using namespace hermes::softwaretrigger;

struct SignalChange {
    double time; // monotonic
    int bit;
    bool on;
};
static std::vector<SignalChange> signalChanges;
static bool hasSignals = true; // what the port is made to seem

extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept {
    va_list arguments;
    va_start(arguments, request);
    void *const argument = va_arg(arguments, void *);
    va_end(arguments);
    if (hasSignals && (request == TIOCMBIS || request == TIOCMBIC)) {
        signalChanges.push_back({monotonicNow(), *static_cast<int *>(argument), request == TIOCMBIS});
        return 0;
    }
    return int(::syscall(SYS_ioctl, descriptor, request, argument));
}

class TestTriggerSerial : public QObject, TriggerFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        signalChanges.clear();
        hasSignals = true;
        setUp();
    }

    void cleanup() {
        tearDown();
        for (int *end : {&farEnd_, &nearEnd_}) {
            if (*end >= 0)
                ::close(*end);
            *end = -1;
        }
    }

    void bytesOnASerialLine() {
        const QString url = openTerminal();
        define("text", byCommand(), {QJsonObject{{"do", "serial"}, {"url", url}, {"text", "Grüße\r\n"}}});
        define("hex", byCommand(), {QJsonObject{{"do", "serial"}, {"url", url}, {"hex", "00ff1103"}}});
        QTRY_VERIFY(healthItem("serial_lines")["level"] == "ok");
        QVERIFY2(fire("text")["ok"].toBool(), qPrintable(healthItem("actions")["message"].toString()));
        QVERIFY(fire("hex")["ok"].toBool());
        QByteArray received;
        const QByteArray expected = QByteArray("Grüße\r\n") + QByteArray::fromHex("00ff1103");
        const auto read = [&] {
            char buffer[64];
            const ssize_t size = ::read(farEnd_, buffer, sizeof buffer);
            received.append(buffer, int(std::max<ssize_t>(size, 0)));
            return received.size() >= expected.size();
        };
        QTRY_VERIFY(read());
        QCOMPARE(received, expected);
        define("nowhere", byCommand(),
               {QJsonObject{{"do", "serial"}, {"url", "serial:///dev/no-such-line"}, {"text", "a"}}});
        const QJsonValue result = fire("nowhere")["results"].toArray().at(0);
        QVERIFY(result["error"]["message"].toString().contains("no-such-line"));
        QVERIFY(healthItem("serial_lines")["message"].toString().contains("no-such-line"));
    }

    void pulseOfASerialLine() {
        const QString url = openTerminal();
        const QJsonObject pulse{{"do", "pulse"}, {"url", url}, {"line", "rts"}, {"length_s", 0.1}};
        define("t", byCommand(), {pulse});
        QTRY_COMPARE(signalChanges.size(), size_t(1)); // low from the opening on
        QCOMPARE(signalChanges[0].bit, TIOCM_RTS);
        QCOMPARE(signalChanges[0].on, false);
        const QJsonValue firing = fire("t");
        QVERIFY(firing["ok"].toBool());
        QCOMPARE(signalChanges.size(), size_t(3));
        QVERIFY(signalChanges[1].on && !signalChanges[2].on);
        QCOMPARE(signalChanges[2].bit, TIOCM_RTS);
        const double length = signalChanges[2].time - signalChanges[1].time;
        QVERIFY2(length >= 0.099 && length < 1, saying(length));
        // At the firing, and within the time that is told.
        const double begin = firing["mono"].toDouble();
        const double end = begin + firing["results"].toArray().at(0)["duration_s"].toDouble();
        QVERIFY(signalChanges[1].time >= begin && signalChanges[2].time <= end + 1e-3);
        // Two pulses of one line do not overlap.
        define("both", byCommand(), {pulse, pulse});
        const QJsonArray results = fire("both")["results"].toArray();
        QVERIFY(results.at(0)["ok"].toBool());
        QCOMPARE(results.at(1)["error"]["code"].toInt(), int(ErrorCode::NotReady));
        QCOMPARE(signalChanges.size(), size_t(5));
    }

    void pulseWithoutTheLine() {
        hasSignals = false;
        const QString url = openTerminal();
        define("t", byCommand(),
               {QJsonObject{{"do", "pulse"}, {"url", url}, {"line", "dtr"}, {"length_s", 0.1}},
                QJsonObject{{"do", "serial"}, {"url", url}, {"text", "a"}}});
        const QJsonArray results = fire("t")["results"].toArray();
        QCOMPARE(results.at(0)["error"]["code"].toInt(), int(ErrorCode::DeviceFault));
        VERIFY_CONTAINS(results.at(0)["error"]["message"].toString(), "DTR");
        QVERIFY(results.at(1)["ok"].toBool()); // the port works on
    }

private:
    QString openTerminal() {
        termios raw{};
        cfmakeraw(&raw);
        char name[256] = {};
        if (openpty(&farEnd_, &nearEnd_, name, &raw, nullptr) == 0)
            fcntl(farEnd_, F_SETFL, O_NONBLOCK);
        return "serial://" + QString(name);
    }

    int farEnd_ = -1, nearEnd_ = -1;
};
