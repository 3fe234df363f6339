#include "gui/hermesctl/Conformance.h"

#include "common/client/DaemonAddress.h"
#include "gui/hermesctl/Question.h"

#include <QEventLoop>
#include <QTimer>
#include <cmath>
#include <memory>

namespace hermes::ctl {
namespace {

QString textOf(const Result<QJsonValue> &answer) {
    return answer ? "accepted" : QString("%1 (%2)").arg(answer.error().message).arg(answer.error().code);
}

bool isMoving(const OdometryMessage &message, const Pose2D &before) {
    const Twist2D &twist = message.twist;
    const Pose2D moved = before.inverse() * message.pose;
    return std::hypot(twist.vx, twist.vy) > 0.01 || std::abs(twist.omega) > 0.03 ||
           std::hypot(moved.x, moved.y) > 5e-4 || std::abs(moved.theta) > 2e-3;
}

} // namespace

Conformance::Conformance(const Arguments &arguments)
    : arguments_(arguments) {
    QObject::connect(&signals_, &SignalWatcher::received, &signals_, [this] { isEnded_ = true; });
}

void Conformance::tell(const QString &level, const QString &what, const QString &expected,
                       const QString &found) {
    if (isEnded_)
        return;
    ++told_[level];
    const QString known = found.isEmpty() ? level == "ok" ? "as expected" : "not so" : found;
    const QString rest = level == "ok" ? QString() : ", expected: " + expected;
    print(arguments_, QJsonObject{{"level", level}, {"what", what}, {"found", known}, {"expected", expected}},
          printable(QString("%1  %2: %3%4").arg(level, -4).arg(what, known, rest)));
}

QJsonValue Conformance::accepted(const QString &what, const Result<QJsonValue> &answer) {
    must(what, bool(answer), "accepted", textOf(answer));
    return answer ? *answer : QJsonValue();
}

void Conformance::refused(const QString &what, const Result<QJsonValue> &answer,
                          const std::vector<ErrorCode> &codes) {
    QStringList numbers;
    for (const ErrorCode code : codes)
        numbers.append(QString::number(int(code)));
    must(what, !answer && numbers.contains(QString::number(answer.error().code)),
         "refused with " + numbers.join(" or "), textOf(answer));
}

Result<void> Conformance::connectTo(Client &client, const QString &name) {
    const auto address = daemonAddress(name, arguments_.host);
    return address ? connectOnce(client, *address, arguments_.timeout) : address.error();
}

void Conformance::pass(double seconds) {
    QEventLoop loop;
    QObject::connect(&signals_, &SignalWatcher::received, &loop, &QEventLoop::quit);
    QTimer::singleShot(int(std::ceil(seconds * 1000)), Qt::PreciseTimer, &loop, &QEventLoop::quit);
    isEnded_ = isEnded_ || readerIsGone();
    if (!isEnded_)
        loop.exec();
}

Result<void> Conformance::driveFor(Client &client, const Twist2D &velocity, double seconds) {
    const auto failure = std::make_shared<Result<void>>();
    for (const double until = monotonicNow() + seconds; monotonicNow() < until && !isEnded_; pass(0.05))
        client.call("motor.drive", asJson(velocity), [failure](const Result<QJsonValue> &answer) {
            if (!answer && *failure)
                *failure = answer.error();
        });
    return *failure;
}

double Conformance::standsAfter(const OdometryRecord &odometry, double since, double most_s) {
    constexpr double still_s = 0.4;
    const auto &all = odometry.all;
    double last = since;
    for (std::size_t next = 1; monotonicNow() < since + most_s && !isEnded_; pass(0.02)) {
        for (; next < all.size(); ++next)
            if (all[next].came > since && isMoving(all[next].data, all[next - 1].data.pose))
                last = all[next].came;
        if (!all.empty() && all.back().came > last + still_s)
            return last - since;
    }
    return most_s;
}

Result<void> Conformance::result() const {
    if (isEnded_)
        return Error(ErrorCode::NotReady,
                     "ended before all was tried, by a signal or because nobody reads this");
    const QString counts =
        QString("%1 hold, %2 with a warning").arg(told_.value("ok")).arg(told_.value("warn"));
    if (const int failures = told_.value("fail"); failures > 0)
        return Error(ErrorCode::DeviceFault, QString("%1 do not hold; %2").arg(failures).arg(counts));
    if (!arguments_.json)
        printLine("it conforms: " + counts);
    return {};
}

Result<void> confirmFreeWheels(const Arguments &arguments) {
    const QString why = "the wheels turn in this test, and a daemon that fails it may not stop them";
    if (arguments.yes || (canAsk() && isConfirmed(why + ". Are they off the ground, with a switch at hand?")))
        return {};
    return Error(ErrorCode::NotReady, why + ": lift them off the ground, and say so with --yes");
}

} // namespace hermes::ctl
