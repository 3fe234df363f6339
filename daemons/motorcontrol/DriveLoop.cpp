#include "daemons/motorcontrol/DriveLoop.h"

#include "common/Realtime.h"
#include "common/Time.h"
#include "common/interface/InterfaceRegistry.h"

#include <cerrno>
#include <cstring>

namespace hermes::motorcontrol {
namespace {

constexpr int realtimePriority = 20;
constexpr double shutdown_s = 0.15; // for the last set-point

Error systemError(const char *what) {
    return Error(ErrorCode::InternalError,
                 QString("the system gives no %1: %2").arg(what, std::strerror(errno)));
}

} // namespace

DriveLoop::DriveLoop(const MotorSettings &settings, DriveMail &mail)
    : settings_(settings)
    , mail_(mail)
    , engine_(settings)
    , timer_([this] { cycle(); }, this)
    , longestGap_s_(settings.drive.commandTimeout_s) {}

Result<void> DriveLoop::start() {
    engine_.report().realtime = becomeRealtime(realtimePriority);
    const auto opened = openLines();
    if (!opened)
        return opened;
    if (mail_.asked.descriptor() < 0)
        return systemError("event descriptor");
    jobs_ = std::make_unique<QSocketNotifier>(mail_.asked.descriptor(), QSocketNotifier::Read);
    connect(jobs_.get(), &QSocketNotifier::activated, this, &DriveLoop::doJobs);
    if (!timer_.start(period))
        return systemError("timer");
    return {};
}

Result<void> DriveLoop::openLines() {
    const std::size_t count = settings_.controllers.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (lineOf_[i])
            continue;
        const QString url = settings_.controllers[i].url;
        const auto parsed = InterfaceUrl::parse(url);
        const auto interface = parsed ? makeInterface(*parsed, nullptr) : Result<Interface *>(parsed.error());
        if (!interface)
            return Error(ErrorCode::InvalidSetting,
                         QString("controllers.%1.url: %2").arg(i + 1).arg(interface.error().message));
        std::vector<MotorController *> onLine;
        for (std::size_t k = i; k < count; ++k) {
            if (settings_.controllers[k].url == url)
                onLine.push_back(&engine_.controller(int(k)));
        }
        const QString device = parsed->scheme == "serial" ? parsed->path : QString();
        lines_.push_back(new ControllerLine(*interface, device, onLine, this));
        lines_.back()->setGuard([this] { lookForGap(); });
        for (std::size_t k = i; k < count; ++k) {
            if (settings_.controllers[k].url != url)
                continue;
            lineOf_[k] = lines_.back();
            engine_.report().controllers[k].interface = (*interface)->name();
        }
        lines_.back()->open();
    }
    return {};
}

void DriveLoop::shutDown(std::function<void()> done) {
    engine_.retire("the daemon is stopping");
    if (!timer_.isRunning())
        return done();
    done_ = std::move(done);
    doneLatest_ = monotonicNow() + shutdown_s;
    wakeLines();
}

void DriveLoop::configure(const MotorSettings &settings) {
    longestGap_s_ = settings.drive.commandTimeout_s;
    engine_.configure(settings);
}

// Jobs and answers may come before the cycle that is late.
void DriveLoop::lookForGap() {
    const double now = bootNow(), passed = now - std::exchange(lastLook_, now);
    if (passed <= longestGap_s_ || passed == now)
        return;
    voidUntil_ = now;
    stopper_ = 0;
    engine_.drive().stoodStill(QString("the drive loop stood still for %1 s").arg(passed, 0, 'f', 2));
    engine_.obey();
}

void DriveLoop::doJobs() {
    lookForGap();
    const auto &jobs = mail_.asked.take();
    for (DriveMail::Job *job : jobs) {
        job->result = job->work(*this);
        if (engine_.obey())
            wakeLines();
    }
    mail_.finished += jobs.size();
    if (!jobs.empty())
        report();
}

void DriveLoop::cycle() {
    lookForGap();
    const double now = monotonicNow();
    const bool obeyed = engine_.hasObeyed(); // before the cycle gives the next set-point
    engine_.cycle(now);
    wakeLines();
    report();
    if (done_ && (obeyed || now > doneLatest_)) {
        timer_.stop();
        std::exchange(done_, {})();
    }
}

void DriveLoop::wakeLines() {
    for (ControllerLine *line : lines_)
        line->wake();
}

void DriveLoop::report() {
    Telemetry &telemetry = engine_.report();
    for (std::size_t i = 0; i < telemetry.controllers.size(); ++i) {
        const LineMaster &line = lineOf_[i]->master();
        telemetry.controllers[i].counts = line.counts(engine_.controller(int(i)));
        telemetry.controllers[i].strayBytes = line.strayBytes();
        telemetry.controllers[i].advice = lineOf_[i]->advice();
    }
    telemetry.stamp = Moment::ofMono(telemetry.mono).stamp();
    telemetry.cycle = timer_.statistics();
    telemetry.unread += !mail_.reports.post(telemetry);
}

} // namespace hermes::motorcontrol
