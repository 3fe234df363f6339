#include "common/network/Announcement.h"

#include "common/OwnRobot.h"
#include "common/Project.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/network/Publisher.h"

#include <cstdlib>
#include <utility>

namespace hermes {
namespace {

bool isHeld = false;

constexpr int longestRecord = 255; // bytes of a record (RFC 6763, section 6.1)

/// A record of text that takes no more than there is room for.
QByteArray record(const char *key, QString value) {
    while (QByteArray(key).size() + 1 + value.toUtf8().size() > longestRecord)
        value.chop(std::as_const(value).back().isLowSurrogate() ? 2 : 1);
    return QByteArray(key) + '=' + value.toUtf8();
}

} // namespace

std::optional<AnnouncedPort> AnnouncedPort::of(const QString &daemon, const QString &setting,
                                               const QString &address) {
    const auto wanted = InterfaceUrl::parse(setting), real = InterfaceUrl::parse(address);
    if (!wanted || !real || !isReachable(*wanted) || wanted->scheme == "udp")
        return std::nullopt;
    const QString tls = wanted->scheme == "tls" ? "yes" : "no";
    AnnouncedPort result;
    result.port = real->port;
    for (const QString &text :
         {"name=" + daemon, "protocol=" + protocolVersion(), "framing=" + wanted->protocol(), "tls=" + tls})
        result.texts.append(text.toUtf8());
    return result;
}

Announcement::Announcement(const QString &daemon, const std::vector<AnnouncedPort> &ports)
    : thread_(new QThread) {
    std::vector<AnnouncedPort> told = ports;
    if (const auto robot = ownRobot())
        for (AnnouncedPort &port : told)
            port.texts << record("robot", robot->name) << record("robot_id", robot->id);
    auto *publisher = new Publisher(daemon, told);
    publisher->moveToThread(thread_);
    QObject::connect(thread_, &QThread::started, publisher, &Publisher::begin);
    QObject::connect(thread_, &QThread::finished, publisher, &QObject::deleteLater);
    thread_->start();
}

Announcement::~Announcement() {
    thread_->quit();
    if (thread_->wait(QDeadlineTimer(std::chrono::milliseconds(500))))
        delete thread_;
    else
        isHeld = true;
}

void Announcement::endProgramIfHeld(int status) {
    if (!isHeld)
        return;
    std::fflush(nullptr);
    std::_Exit(status);
}

} // namespace hermes
