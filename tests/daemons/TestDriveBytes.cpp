// Every byte that goes to two RoboClaws on a line, the millisecond when it goes, and what is told of them:
// set-up, driving, faults, stops and new settings, drawn from a number. A change that shall leave the wire
// alone leaves the digests alone; another one takes the new ones.
#include "ControllerBench.h"

#include <random>

using namespace hermes;
using namespace hermes::motorcontrol;
using roboclaw::Command;

class TestDriveBytes : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void theSameDriveSendsTheSame_data() {
        const Rows<unsigned, int, quint64> row("seed", "packets", "digest");
        row("first", 1u, 20130, Q_UINT64_C(5808207241927646618));
        row("second", 2u, 24167, Q_UINT64_C(611814302670747907));
        row("third", 3u, 20302, Q_UINT64_C(10451760777494255764));
        row("fourth", 4u, 18447, Q_UINT64_C(770754021872184699));
    }

    void theSameDriveSendsTheSame() {
        FETCH(unsigned, seed, int, packets, quint64, digest);
        ControllerBench bench;
        std::mt19937 random(seed);
        const auto draw = [&](unsigned below) { return int(random() % below); };
        unsigned lost = 0;                // of 16 answers
        auto unanswered = Command::Speed; // which the motor control never sends
        bench.passes = [&](const ControllerBench::Packet &packet, const ControllerBench::Bytes &bytes) {
            return random() % 16 < lost || packet.command() == unanswered ? std::nullopt
                                                                          : std::optional(bytes);
        };
        quint64 sum = Q_UINT64_C(0xcbf29ce484222325); // FNV-1a
        const auto add = [&](std::uint64_t value) { sum = (sum ^ value) * Q_UINT64_C(0x100000001b3); };
        for (int event = 0; event < 250; ++event) {
            MotorController &controller = bench.controller(draw(2));
            auto &emulator = bench.emulator(draw(2));
            switch (draw(16)) {
            case 0:
                emulator.restart(0.1 * draw(10));
                break;
            case 1:
                emulator.faults().deaf = !emulator.faults().deaf;
                break;
            case 2:
                emulator.faults().latched = !emulator.faults().latched;
                break;
            case 3:
                emulator.faults().delay = 0.005 * draw(20);
                break;
            case 4:
                lost = unsigned(draw(17));
                break;
            case 5:
                unanswered = Command(std::array{37, 48, 78, 40, 15, 82, 29, 14}[std::size_t(draw(8))]);
                break;
            case 6:
                controller.bar("drawn");
                break;
            case 7:
                controller.release();
                break;
            case 8:
                bench.line->setClosed("drawn");
                bench.line->setOpen();
                break;
            case 9:
                bench.settings.serialTimeout_s = 0.1 * (1 + draw(5));
                bench.settings.pid.p = 1 + draw(3);
                controller.configure(bench.settings);
                break;
            case 10: // all is mended
            case 11:
                lost = 0;
                unanswered = Command::Speed;
                for (int i = 0; i < 2; ++i) {
                    bench.emulator(i).faults() = {};
                    bench.controller(i).release();
                }
                break;
            default:
                bench.speed = draw(3) == 0 ? 0 : draw(40000) - 20000;
            }
            bench.run(0.04 * draw(40));
            for (int i = 0; i < 2; ++i) {
                for (const QChar letter : bench.controller(i).error())
                    add(letter.unicode());
            }
        }
        std::set<Command> commands;
        for (const auto &packet : bench.sent) {
            add(std::uint64_t(std::llround(1000 * packet.time)));
            for (std::size_t i = 0; i < packet.bytes.size(); ++i)
                add(packet.bytes[i]);
            commands.insert(packet.command());
        }
        QCOMPARE(int(commands.size()), 16); // all that it ever sends
        QCOMPARE(int(bench.sent.size()), packets);
        QCOMPARE(sum, digest);
    }
};
