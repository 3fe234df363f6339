// Every revolution that a scanner turns is published or counted as missed, whatever holds up host or line.
#include "ScannerBench.h"
#include "tests/protocol/ScannerReader.h"
#include "tests/support/Seed.h"

using namespace hermes::scan;

namespace {

/// An emulated scanner, the line with the buffer of a driver, and who reads it.
struct Host {
    static constexpr int bufferSize = 4096; ///< bytes of the driver

    explicit Host(const QString &model, const char *read)
        : bench(model)
        , reader(read) {
        reader.scanner->opened(now_ns());
    }

    std::int64_t now_ns() const {
        return bench.now_ns - start_ns + 1000000000000;
    } ///< some time after the boot
    /// reads: else the driver keeps what it can.
    void run(double seconds, bool reads = true) {
        for (const std::int64_t end_ns = bench.now_ns + std::int64_t(seconds * 1e9); bench.now_ns < end_ns;) {
            line = (line + bench.pass(0.002)).left(bufferSize);
            if (!reads)
                continue;
            reader.scanner->feed(line.toStdString(), {bench.now_ns, now_ns()});
            line.clear();
            bench.scanner->receive(reader.scanner->next(now_ns()).send, bench.now_ns);
        }
    }
    std::int64_t turned() const { return std::int64_t(bench.scanner->revolutions()); }
    std::int64_t told() const {
        const RevolutionAssembler::Counts counts = reader.assembler.counts();
        return std::int64_t(counts.revolutions + counts.partial + counts.missed);
    }

    Bench bench;
    ScannerReader reader;
    QByteArray line;
};

} // namespace

class TestLostRevolutions : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void nothingVanishesUncounted_data() {
        const Rows<QString, QString, bool> row("model", "read", "isMachine");
        for (const char *name :
             {"rplidar-a1", "rplidar-c1", "ld06", "ydlidar-x4", "hokuyo-ust10lx", "sick-tim571"})
            for (const bool isMachine : {false, true}) {
                const QString model = name;
                row(qPrintable(model + (isMachine ? ", machine" : ", reader")), model,
                    model.startsWith("sick") ? "sick-tim5xx" : model, isMachine);
            }
    }

    /// The program that reads stands still for a while, or all of the machine but the head does.
    void nothingVanishesUncounted() {
        FETCH(QString, model, QString, read, bool, isMachine);
        std::mt19937 random(newSeed());
        const auto between = [&random](double least, double most) {
            return std::uniform_real_distribution<double>(least, most)(random);
        };
        Host host(model, read.toUtf8().constData());
        host.run(12); // the motor turns, and the rate of the beams is known
        QVERIFY(host.told() > 50);
        const std::int64_t turned = host.turned(), told = host.told();
        std::uint64_t partial = host.reader.assembler.counts().partial;
        for (int stall = 0; stall < 4; ++stall) {
            const double stall_s = between(0.2, 3);
            if (isMachine)
                host.bench.now_ns += std::int64_t(stall_s * 1e9);
            else
                host.run(stall_s, false);
            host.run(between(4, 5));
            const std::int64_t uncounted = host.turned() - turned - (host.told() - told);
            QVERIFY2(
                std::abs(uncounted) <= 1,
                qPrintable(
                    QString("after %1 s: %2 of %3").arg(stall_s).arg(uncounted).arg(host.turned() - turned)));
        }
        const RevolutionAssembler::Counts counts = host.reader.assembler.counts();
        QVERIFY(counts.missed > 0);
        QVERIFY(counts.partial - partial <= 30);
    }
};

QTEST_GUILESS_MAIN(TestLostRevolutions)
#include "TestLostRevolutions.moc"
