#include "daemons/simulator/GpsLine.h"

namespace hermes {

Result<void> GpsLine::open(const QString &link) {
    auto opened = openDeviceLine(link);
    if (!opened)
        return opened.error();
    pty_ = *opened;
    link_ = link;
    return {};
}

void GpsLine::send(const QByteArray &sentences) {
    if (!pty_ || !pty_->isOpen())
        return;
    if (pty_->unread() > mostUnread)
        lost_ += pty_->discardUnread();
    if (pty_->write(sentences))
        sent_ += sentences.size();
    else
        lost_ += sentences.size();
}

void GpsLine::setPulled(bool pulled) {
    if (pulled)
        pty_->close();
    else
        pty_->open();
}

QJsonObject GpsLine::toJson() const {
    return {{"link", link_},
            {"device", pty_ ? pty_->device() : QString()},
            {"bytes", double(sent_)},
            {"unread_lost", double(lost_)}};
}

} // namespace hermes
