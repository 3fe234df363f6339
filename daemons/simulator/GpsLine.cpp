#include "daemons/simulator/GpsLine.h"

namespace hermes::simulator {

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
    if (pty_->unread() > mostUnread)
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

} // namespace hermes::simulator
