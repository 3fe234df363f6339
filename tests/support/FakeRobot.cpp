#include "tests/support/FakeRobot.h"

#include "common/interface/InterfaceKinds.h"
#include "daemons/motorcontrol/MotorControl.h"
#include "tests/support/FreePort.h"

#include <QtTest>

namespace hermes {

using Answers = std::vector<simulator::RoboClawEmulator::Answer>;

/// The host's end of the line.
class FakeRobot::Line : public Interface {
public:
    Line(FakeRobot &robot, QObject *parent)
        : Interface(parent)
        , robot_(robot) {
        robot.line_ = this;
    }

    /// For all serial lines of this process, whose paths are the addresses of their robots.
    static Interface *make(const InterfaceUrl &url, QObject *parent) {
        return new Line(*reinterpret_cast<FakeRobot *>(url.path.midRef(1).toULongLong()), parent);
    }
    QString name() const override { return QStringLiteral("fake"); }
    qint64 bytesToWrite() const override { return 0; }

protected:
    void doOpen() override { nowOpen(); }
    void doClose() override {}
    bool doWrite(const QByteArray &bytes) override {
        const Answers answers = robot_.with([&](simulator::Drivetrain &motors) {
            const auto *const data = reinterpret_cast<const std::uint8_t *>(bytes.constData());
            const Answers all = motors.receive(0, data, std::size_t(bytes.size()), robot_.last_);
            return robot_.isSilent_ ? Answers() : all;
        });
        for (const auto &[answer, delay] : answers) {
            const QByteArray out(reinterpret_cast<const char *>(answer.data()), int(answer.size()));
            const double passed = delay + (bytes.size() + out.size()) / 11520.0; // 115,200 baud
            QTimer::singleShot(int(std::ceil(1000 * passed)), Qt::PreciseTimer, this,
                               [this, out] { nowReceived(out); });
        }
        return true;
    }

private:
    FakeRobot &robot_;
};

template <typename Work>
void FakeRobot::inThread(const Work &work) {
    QMetaObject::invokeMethod(&home_, work, Qt::BlockingQueuedConnection);
}

FakeRobot::FakeRobot(const QStringList &settings)
    : settings_(settings)
    , port_(reservePort())
    , last_(monotonicNow()) {
    for (InterfaceKind &kind : interfaceKinds())
        if (QLatin1String(kind.scheme) == "serial")
            kind.connect = Line::make;
    home_.moveToThread(&thread_);
    thread_.start();
    start();
}

FakeRobot::~FakeRobot() {
    end();
    thread_.quit();
    thread_.wait();
}

void FakeRobot::end() {
    thaw();
    inThread([this] {
        if (daemon_)
            daemon_->shutDown();
        delete std::exchange(daemon_, nullptr);
    });
}

void FakeRobot::start() {
    const QString line = QString("serial:///%1").arg(reinterpret_cast<quintptr>(this));
    QStringList arguments{"motorcontrol", "--listen", "tcp://" + address() + "?protocol=json"};
    for (const QString &setting :
         QStringList{"controllers.1.url=" + line, "controllers.2.url=" + line, "safety.command_timeout_s=1"} +
             settings_)
        arguments << "--set" << setting;
    qputenv("STATE_DIRECTORY", QFile::encodeName(state_.path()));
    inThread([&] {
        daemon_ = new motorcontrol::MotorControl;
        if (daemon_->prepare(arguments) || !daemon_->launch())
            qFatal("the motor control does not start");
    });
    int ready = 0; // controllers
    const auto look = [&] {
        ready = 0;
        for (const HealthItem &item : daemon_->status().health)
            ready += item.name.startsWith("controller_") && (item.level == "ok" || item.level == "warn");
    };
    QTRY_COMPARE((inThread(look), ready), 2);
}

void FakeRobot::freeze() {
    isFrozen_ = true;
    QSemaphore stands;
    for (QObject *const one : {line_, &home_}) {
        QMetaObject::invokeMethod(
            one,
            [&] {
                stands.release();
                thawing_.acquire();
            },
            Qt::QueuedConnection);
        stands.acquire();
    }
}

void FakeRobot::thaw() {
    if (std::exchange(isFrozen_, false))
        thawing_.release(2);
}

void FakeRobot::setSilent(bool silent) {
    with([&](simulator::Drivetrain &) { isSilent_ = silent; });
}

void FakeRobot::advance() {
    constexpr double longestStep = 0.001; // seconds
    for (const double now = monotonicNow(); last_ < now;) {
        const double step = std::min(longestStep, now - last_);
        motors_.advance(step);
        last_ = step < longestStep ? now : last_ + step;
    }
}

} // namespace hermes
