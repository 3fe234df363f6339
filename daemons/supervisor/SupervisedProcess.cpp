#include "daemons/supervisor/SupervisedProcess.h"

#include "common/Log.h"
#include "common/Project.h"
#include "common/Time.h"
#include "daemons/supervisor/ProcessFamily.h"
#include "daemons/supervisor/ProcessUsage.h"

#include <QCoreApplication>
#include <QFileInfo>
#include <QJsonObject>
#include <QUuid>
#include <csignal>
#include <sys/prctl.h>

namespace hermes::supervisor {
namespace {

constexpr int longestLine = 4096;

/// "signal 9 (SIGKILL)".
QString signalName(int number) {
    const char *const name = sigabbrev_np(number);
    return QString("signal %1").arg(number) + (name ? QString(" (SIG%1)").arg(name) : QString());
}

} // namespace

QString toString(SupervisedProcess::State state) {
    switch (state) {
    case SupervisedProcess::State::Stopped:
        return "stopped";
    case SupervisedProcess::State::Running:
        return "running";
    case SupervisedProcess::State::Stopping:
        return "stopping";
    case SupervisedProcess::State::Waiting:
        return "waiting";
    case SupervisedProcess::State::Failed:
        break;
    }
    return "failed";
}

QJsonArray usualProcesses() {
    QJsonArray all;
    for (const QString &name : daemonNames())
        if (name != "supervisor")
            all.append(QJsonObject{{"name", name}});
    return all;
}

void SupervisedProcess::Child::setupChildProcess() {
    ::setpgid(0, 0); // those that it starts are of its group, and Ctrl-C in a terminal is for the supervisor,
                     // which ends them
    prctl(PR_SET_PDEATHSIG, SIGTERM);
}

SupervisedProcess::SupervisedProcess(const ProcessEntry &entry, std::shared_ptr<ProcessGuard> guard,
                                     QObject *parent)
    : QObject(parent)
    , entry_(entry)
    , guard_(std::move(guard))
    , family_(QUuid::createUuid().toString(QUuid::Id128)) {
    process_.setProcessChannelMode(QProcess::MergedChannels);
    process_.setStandardInputFile(QProcess::nullDevice());
    connect(&process_, &QProcess::readyRead, this, &SupervisedProcess::readOutput);
    connect(&process_, QOverload<int, QProcess::ExitStatus>::of(&QProcess::finished), this,
            &SupervisedProcess::onEnded);
    connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
        if (error == QProcess::FailedToStart)
            onFailedToStart();
    });
    connect(&process_, &QProcess::started, this, [this] {
        logInfo("process",
                QString("%1: started with process id %2").arg(entry_.name).arg(process_.processId()));
        group_ = pid_t(process_.processId());
        if (guard_)
            guard_->add(group_);
        if (state_ == State::Stopping)
            process_.terminate();
        Q_EMIT changed();
    });
    retry_.setSingleShot(true);
    connect(&retry_, &QTimer::timeout, this, [this] {
        ++restarts_;
        start();
    });
    kill_.setSingleShot(true);
    connect(&kill_, &QTimer::timeout, this, [this] {
        logWarning("process", QString("%1: did not end within %2 s, killed")
                                  .arg(entry_.name)
                                  .arg(double(killAfter.count()) / 1000));
        process_.kill();
    });
}

QString SupervisedProcess::found(const QString &program) {
    const QString beside = QCoreApplication::applicationDirPath() + "/" + program;
    return !program.contains('/') && QFileInfo(beside).isExecutable() ? beside : program;
}

SupervisedProcess::~SupervisedProcess() {
    process_.disconnect(this);
    if (!isAlive())
        return;
    // Of those that were told together none waits for another.
    const bool isTold = state_ == State::Stopping && process_.state() == QProcess::Running;
    const int timeout_ms = isTold ? std::max(kill_.remainingTime(), 1) : int(killAfter.count());
    process_.waitForStarted(int(killAfter.count()));
    if (!isTold)
        process_.terminate();
    if (!process_.waitForFinished(timeout_ms))
        process_.kill();
    process_.waitForFinished(1000);
    endFamily();
}

void SupervisedProcess::endFamily() {
    if (group_ > 1)
        ::kill(-group_, SIGKILL); // also those that have cleared their environment
    if (group_ > 1 && guard_)
        guard_->remove(group_);
    group_ = 0;
    ProcessFamily::end(family_);
}

void SupervisedProcess::start() {
    retry_.stop();
    ++orders_;
    if (isAlive()) {
        startAfterStop_ = state_ == State::Stopping;
        return;
    }
    state_ = State::Running; // at once: a stop may come before the news that it has started
    started_ = measured_ = monotonicNow();
    used_s_ = cpu_ = 0;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert(ProcessFamily::variable, family_);
    for (const char *const ofService : {"NOTIFY_SOCKET", "WATCHDOG_PID", "WATCHDOG_USEC"})
        environment.remove(ofService); // the service manager waits for the supervisor's word alone
    process_.setProcessEnvironment(environment);
    process_.start(found(entry_.program), entry_.arguments);
}

void SupervisedProcess::stop() {
    ++orders_;
    retry_.stop();
    backOff_ = firstBackOff; // what was in the way may be gone
    startAfterStop_ = false;
    if (!isAlive())
        return setState(State::Stopped);
    setState(State::Stopping);
    if (process_.state() == QProcess::Running)
        process_.terminate();
    // Else when it has started: until then the child has the handlers of this program, and SIGTERM would look
    // like one to it.
    kill_.start(killAfter);
}

void SupervisedProcess::restart() {
    stop();
    startAfterStop_ = true;
    if (!isAlive())
        start();
}

void SupervisedProcess::onEnded(int code, QProcess::ExitStatus status) {
    kill_.stop();
    endFamily();
    readOutput();
    if (!partialLine_.isEmpty())
        keepLine(std::exchange(partialLine_, {}));
    const bool wasKilled = status == QProcess::CrashExit; // then the code is the signal's number
    lastExit_ = wasKilled ? "killed by " + signalName(code) : QString("exit status %1").arg(code);
    const bool wasAsked = state_ == State::Stopping;
    const bool isWell = wasAsked || (!wasKilled && code == 0);
    (isWell ? logInfo : logError)("process", QString("%1: ended, %2").arg(entry_.name, lastExit_));
    if (status == QProcess::NormalExit && code != 0 && !lines_.empty())
        lastExit_ += ": " + lines_.back(); // what is wrong, mostly
    if (std::exchange(startAfterStop_, false) && wasAsked) {
        ++restarts_;
        return start();
    }
    if (isWell)
        return setState(State::Stopped);
    if (status == QProcess::NormalExit && code == 2)
        return setState(State::Failed); // a wrong command line or setting does not mend itself
    retryLater();
}

void SupervisedProcess::onFailedToStart() {
    kill_.stop();
    lastExit_ = entry_.program + ": " + process_.errorString();
    logError("process", entry_.name + ": " + lastExit_);
    state_ == State::Stopping ? setState(State::Stopped) : retryLater(); // its disk may not be there yet
}

void SupervisedProcess::retryLater() {
    if (monotonicNow() - started_ > std::chrono::duration<double>(wellAfter).count())
        backOff_ = firstBackOff;
    retry_.start(backOff_);
    backOff_ = std::min(2 * backOff_, longestBackOff);
    setState(State::Waiting);
}

void SupervisedProcess::readOutput() {
    const QByteArray bytes = process_.readAll();
    for (int begin = 0; begin < bytes.size();) {
        const int room = longestLine - partialLine_.size(), end = bytes.indexOf('\n', begin);
        const int size = std::min(room, (end < 0 ? bytes.size() : end) - begin);
        partialLine_ += QByteArray::fromRawData(bytes.constData() + begin, size);
        begin += size;
        const bool isWhole = begin == end;
        if (isWhole || (partialLine_.size() == longestLine && begin < bytes.size()))
            keepLine(std::exchange(partialLine_, {}));
        begin += isWhole;
    }
}

void SupervisedProcess::keepLine(const QByteArray &line) {
    lines_.push_back(QString::fromUtf8(line.constData(), line.size())); // zeros, too
    passLine(lines_.back());
    if (lines_.size() > keptLines)
        lines_.pop_front();
}

/// One that writes without end keeps neither the supervisor nor the log for itself.
void SupervisedProcess::passLine(const QString &line) {
    constexpr double most = 1000, perSecond = 100;
    const double now = monotonicNow();
    mayPass_ = std::min(most, mayPass_ + (now - passed_) * perSecond);
    passed_ = now;
    if (mayPass_ < 1) {
        ++leftOut_;
        return;
    }
    --mayPass_;
    if (leftOut_ > 0)
        logWarning("process", QString("%1: %2 lines are not in the log, it writes more than 100 a second")
                                  .arg(entry_.name)
                                  .arg(std::exchange(leftOut_, 0)));
    Log::instance().pass(entry_.name, line);
}

QStringList SupervisedProcess::output(int lines) const {
    QStringList all(lines_.begin(), lines_.end());
    if (!partialLine_.isEmpty())
        all.append(QString::fromUtf8(partialLine_.constData(), partialLine_.size()));
    return all.mid(std::max(0, all.size() - lines));
}

ProcessStatus SupervisedProcess::status() const {
    ProcessStatus status;
    status.entry = entry_;
    status.state = toString(state_);
    status.restarts = restarts_;
    status.lastExit = lastExit_;
    if (retry_.isActive())
        status.nextStart_s = double(retry_.remainingTime()) / 1000;
    if (isAlive()) {
        status.pid = process_.processId();
        status.uptime_s = monotonicNow() - started_;
        status.memory_bytes = memory_bytes_;
        status.cpu = cpu_;
    }
    return status;
}

void SupervisedProcess::measure() {
    const auto usage = ProcessUsage::of(process_.processId());
    const double now = monotonicNow();
    if (!usage || now <= measured_)
        return;
    cpu_ = std::max(0.0, usage->cpu_s - used_s_) / (now - measured_);
    memory_bytes_ = usage->memory_bytes;
    measured_ = now;
    used_s_ = usage->cpu_s;
}

void SupervisedProcess::setEntry(const ProcessEntry &entry) {
    if (entry == entry_)
        return;
    entry_ = entry;
    const bool isTried = state_ == State::Failed || state_ == State::Waiting; // perhaps it is mended
    if (isAlive() ? state_ != State::Stopping : isTried)
        restart();
}

void SupervisedProcess::setState(State state) {
    state_ = state;
    Q_EMIT changed();
}

} // namespace hermes::supervisor
