#include "daemons/simulator/DeviceLines.h"
#include "common/Time.h"

#include <QTimer>

#include <cmath>

namespace hermes::simulator {

Result<std::shared_ptr<PtyInterface>> openDeviceLine(const QString &link) {
    InterfaceUrl url;
    url.scheme = "pty";
    url.path = link;
    auto pty = std::make_shared<PtyInterface>(url, nullptr);
    QString failure;
    const auto watch = QObject::connect(pty.get(), &Interface::closed, pty.get(),
                                        [&failure](const QString &why) { failure = why; });
    pty->open();
    QObject::disconnect(watch);
    if (!pty->isOpen())
        return Error(ErrorCode::InputOutput, failure);
    return pty;
}

Result<void> GpsLine::open(const QString &link) {
    auto opened = openDeviceLine(link);
    if (!opened)
        return opened.error();
    pty_ = *opened;
    state_.line.link = link;
    return {};
}

void GpsLine::send(const QByteArray &sentences) {
    if (!pty_ || !pty_->isOpen())
        return;
    if (pty_->unread() > maxUnread)
        state_.unreadLost += pty_->discardUnread();
    (pty_->write(sentences) ? state_.bytes : state_.unreadLost) += sentences.size();
}

void GpsLine::setPulled(bool pulled) {
    if (pulled)
        pty_->close();
    else
        pty_->open();
}

const GpsLineState &GpsLine::state() {
    state_.line.device = pty_ ? pty_->device() : QString();
    return state_;
}

Result<void> MotorLines::open(const QStringList &links) {
    close();
    for (const QString &link : links) {
        const auto opened = openDeviceLine(link);
        if (!opened) {
            close();
            return opened.error();
        }
        const int number = count();
        connect(opened->get(), &Interface::received, this,
                [this, number](const QByteArray &bytes) { receive(number, bytes); });
        lines_.push_back({link, *opened});
    }
    return {};
}

void MotorLines::close() {
    lines_.clear();
}

void MotorLines::setPulled(int line, bool pulled) {
    if (pulled)
        lines_[std::size_t(line)].pty->close();
    else
        lines_[std::size_t(line)].pty->open();
}

std::vector<LineState> MotorLines::state() const {
    std::vector<LineState> lines;
    for (const Line &line : lines_)
        lines.push_back({line.link, line.pty->device()});
    return lines;
}

void MotorLines::receive(int line, const QByteArray &bytes) {
    PtyInterface *pty = lines_[std::size_t(line)].pty.get();
    for (const RoboClawEmulator::Answer &answer : device_(line, bytes, monotonicNow())) {
        const QByteArray out(reinterpret_cast<const char *>(answer.bytes.data()), int(answer.bytes.size()));
        if (answer.delay > 0)
            QTimer::singleShot(int(std::ceil(answer.delay * 1000)), Qt::PreciseTimer, pty,
                               [pty, out] { pty->write(out); });
        else
            pty->write(out);
    }
}

} // namespace hermes::simulator
