#include "daemons/motorcontrol/MotorControl.h"

#include "common/Log.h"
#include "common/Time.h"
#include "protocol/wire/Fields.h"

#include <QSocketNotifier>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <future>
#include <sys/resource.h>
#include <tuple>
#include <utility>

namespace hermes::motorcontrol {
namespace {

constexpr quint64 slowEvery = 5; // cycles between two messages of what changes slowly
constexpr std::chrono::milliseconds stopLimit{1000};
// Nobody waits for it.
Reply unanswered() {
    return Reply([](const Result<QJsonValue> &) {});
}

bool isSame(const MotionHold &a, const MotionHold &b) {
    const auto parts = [](const MotionHold &h) {
        return std::tie(h.latched, h.control.held, h.control.holder, h.control.wanted, h.halted, h.cause);
    };
    return parts(a) == parts(b);
}

constexpr int niceness = -11; // where it may: what must stop the robot does not wait behind ordinary work

} // namespace

MotorControl::MotorControl()
    : Daemon({"motorcontrol", "Motor control",
              "Drives the wheels through RoboClaws, VESCs, Roboteqs, an OpenCR or an Arduino, tells where "
              "they have brought the robot, "
              "and stops when anything breaks"}) {
    feedWatchdogMyself();
    declareMotorSettings(settings());
    settings().addRule(checkMotorSettings);
    declareTopics();
    declareMotorCommands();
    declareControlCommands();
    connect(&server().gaps(), &GapWatch::ended, this, &MotorControl::afterGap);
    connect(this, &Daemon::clientGone, this, [this](quint64 client) {
        if (loop_)
            inLoop(
                [client](DriveLoop &loop) -> Result<QJsonValue> {
                    loop.drive().clientGone(client);
                    return QJsonValue();
                },
                unanswered());
    });
}

MotorControl::~MotorControl() {
    stop();
}

void MotorControl::declareTopics() {
    addTopic(Topic("odometry", "Where the wheels have brought the robot, after each cycle (50 Hz)")
                 .carries<OdometryMessage>());
    addTopic(Topic("wheels", "How each wheel turns, after each cycle").carries<WheelsMessage>());
    addTopic(Topic("control", "Who holds the control, why the robot halted last and what is latched, when it "
                              "changes")
                 .carries<MotionHold>()
                 .snapshot([this] { return Outgoing(holdOf(told_)); }));
    addTopic(Topic("power", "What each controller measures, at 10 Hz").carries<PowerMessage>());
}

Result<void> MotorControl::start() {
    active_ = MotorSettings::from(settings());
    told_.controllers.count = active_.controllers.size();
    gauge_.configure(active_.gauge);
    server().gaps().watch(active_.drive.commandTimeout_s);
    if (::getpriority(PRIO_PROCESS, 0) > niceness)
        ::setpriority(PRIO_PROCESS, 0, niceness);
    if (mail_.reports.descriptor() < 0)
        return Error(ErrorCode::InternalError,
                     QString("the system gives no event descriptor: %1").arg(std::strerror(errno)));
    connect(new QSocketNotifier(mail_.reports.descriptor(), QSocketNotifier::Read, this),
            &QSocketNotifier::activated, this, &MotorControl::takeReports);
    loop_ = new DriveLoop(active_, mail_);
    loop_->moveToThread(&thread_);
    connect(&thread_, &QThread::finished, loop_, &QObject::deleteLater);
    thread_.setObjectName("drive");
    thread_.start();
    restoreStop();
    Result<void> outcome;
    QMetaObject::invokeMethod(
        loop_, [&] { outcome = loop_->start(); }, Qt::BlockingQueuedConnection);
    health().expectEvery("cycle", std::chrono::seconds(1));
    return outcome;
}

void MotorControl::restoreStop() {
    QStringList listen, lines;
    for (const QJsonValue &address : settings().value("listen").toArray())
        listen.append(address.toString());
    for (const ControllerAddress &controller : active_.controllers)
        lines.append(controller.url);
    latchFile_.setPlace(settings().file(), listen, lines);
    const auto room = latchFile_.reserve();
    unkept_ = room ? QString() : room.error().message;
    const auto reason = latchFile_.read();
    if (!reason)
        return;
    logWarning("stop", *reason + ", before this program was started; it stays until motor.reset_estop");
    QMetaObject::invokeMethod(
        loop_,
        [this, &reason] {
            loop_->drive().restoreStop(*reason, monotonicNow());
            told_.latch = loop_->drive().latch(); // who asks before the first report is told so
        },
        Qt::BlockingQueuedConnection);
    keepStop(); // now by what this daemon is known, too
}

void MotorControl::keepStop() {
    const auto kept = latchFile_.write(told_.latch.has(Drive::emergencyCause)
                                           ? std::optional(told_.latch.reason(Drive::emergencyCause))
                                           : std::nullopt);
    unkept_ = kept ? QString() : kept.error().message;
}

void MotorControl::stop() {
    if (!loop_)
        return;
    // Not a blocking call: the loop's thread must still run its event loop to see the answers.
    auto stood = std::make_shared<std::promise<void>>();
    std::future<void> standing = stood->get_future();
    QMetaObject::invokeMethod(
        loop_, [loop = loop_, stood] { loop->shutDown([stood] { stood->set_value(); }); },
        Qt::QueuedConnection);
    if (standing.wait_for(stopLimit) != std::future_status::ready)
        logError("motorcontrol", "the drive loop does not end; the controllers stop by their own time-out");
    thread_.quit();
    thread_.wait();
    loop_ = nullptr;
    answerJobs(mail_.finished.exchange(0));
    for (const WaitingStop &stop : std::exchange(stops_, {}))
        stop.reply.result(asJson(standingOf(told_)));
    for (const DriveMail::Job &job : std::exchange(jobs_, {}))
        job.reply.error(Error(ErrorCode::NotReady, "the daemon is stopping"));
}

void MotorControl::settingsChanged(const QStringList &paths) {
    static const QStringList ofDrive{"controllers.", "pid.",    "frame.",    "wheels.",
                                     "motion.",      "safety.", "odometry.", "faults."};
    const auto concerns = [&paths](const QStringList &groups) {
        return std::any_of(paths.begin(), paths.end(), [&](const QString &path) {
            return std::any_of(groups.begin(), groups.end(),
                               [&](const QString &g) { return path.startsWith(g); });
        });
    };
    if (!loop_)
        return;
    const MotorSettings before = std::exchange(active_, MotorSettings::from(settings()));
    const std::vector<ControllerAddress> awaited = MotorSettings::withWaiting(settings()).controllers;
    active_.areOthersSet =
        !std::equal(awaited.begin(),
                    awaited.begin() + std::ptrdiff_t(std::min(awaited.size(), before.controllers.size())),
                    before.controllers.begin(), [](const auto &a, const auto &b) {
                        return a.model == b.model && a.address == b.address;
                    });
    active_.controllers = before.controllers; // they wait for a restart
    gauge_.configure(active_.gauge);
    if (!concerns(ofDrive))
        return;
    server().gaps().watch(active_.drive.commandTimeout_s);
    static const QStringList ofRobot{"frame.", "wheels."};
    const bool isOther = concerns(ofRobot); // the same command moves it in another way
    inLoop(
        [s = active_, isOther](DriveLoop &loop) {
            if (isOther)
                loop.drive().release(loop.drive().lease().client());
            loop.configure(s);
            return QJsonValue();
        },
        unanswered());
}

void MotorControl::afterGap(const QString &text) {
    logWarning("motorcontrol", text + ": the robot halts, and the control must be acquired anew");
    if (!loop_)
        return;
    inLoop(
        [text](DriveLoop &loop) -> Result<QJsonValue> {
            loop.drive().stoodStill(text);
            return QJsonValue();
        },
        unanswered());
}

void MotorControl::inLoop(const Work &work, const Reply &reply) {
    if (!loop_)
        return reply.error(Error(ErrorCode::NotReady, "the daemon is stopping"));
    jobs_.push_back({work, reply});
    postJobs();
}

void MotorControl::postJobs() {
    while (posted_ < jobs_.size() && mail_.asked.post(&jobs_[posted_]))
        ++posted_;
}

void MotorControl::answerJobs(std::size_t count) {
    for (; count > 0; --count) {
        const DriveMail::Job job = std::move(jobs_.front());
        jobs_.pop_front();
        --posted_;
        job.reply.give(job.result); // may ask for the next one
    }
    postJobs();
}

void MotorControl::takeReports() {
    const std::size_t finished = mail_.finished.exchange(0); // their effect is in the reports
    for (const Telemetry &telemetry : mail_.reports.take())
        show(telemetry);
    answerJobs(finished);
}

void MotorControl::answerStops() {
    const double now = monotonicNow();
    const auto isDue = [&](const WaitingStop &stop) { return allStand(told_) || now >= stop.until; };
    for (const WaitingStop &stop : stops_) {
        if (isDue(stop))
            stop.reply.result(asJson(standingOf(told_)));
    }
    stops_.erase(std::remove_if(stops_.begin(), stops_.end(), isDue), stops_.end());
}

void MotorControl::show(const Telemetry &telemetry) {
    if (telemetry.counterJumps != told_.counterJumps)
        logWarning("drive", "a controller has lost its counts; the odometry goes on from where it was");
    const QString &reason = telemetry.haltReason;
    if (!reason.isEmpty() && !telemetry.latch.isSet() &&
        loggedHalt_ != reason) // a latched one is told as health
        logInfo("stop", loggedHalt_ = reason);
    const bool isNewLatch = telemetry.latch.isSet() != told_.latch.isSet();
    const bool isNewStop =
        telemetry.latch.reason(Drive::emergencyCause) != told_.latch.reason(Drive::emergencyCause);
    const bool isNewHold = !isSame(holdOf(telemetry), holdOf(told_));
    told_ = telemetry;
    if (isNewHold)
        publish("control", holdOf(told_));
    if (isNewStop)
        keepStop();
    if (isNewLatch)
        tellStop(); // at once; all else of health waits for the next cycles
    answerStops();
    if (!telemetry.moved && cycles_ == telemetry.cycle.cycles)
        return; // a report between two cycles
    cycles_ = telemetry.cycle.cycles;
    if (telemetry.moved) {
        publish(
            "odometry", [&] { return odometryOf(telemetry); }, telemetry.stamp);
        publish(
            "wheels", [&] { return wheelsOf(telemetry, active_.drive.layout); }, telemetry.stamp);
    }
    if (cycles_ % slowEvery == 0) {
        gauge_.take(bootNow(), batteryOf(telemetry));
        publish("power", [&] { return powerOf(telemetry, gauge_.state()); });
        updateHealth();
        feedWatchdog();
    }
}

} // namespace hermes::motorcontrol
