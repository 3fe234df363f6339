#include "protocol/jsonrpc/CborContent.h"

#include "protocol/wire/CborWriter.h"

namespace hermes {
namespace {

constexpr char endOfContainer = '\xff';
constexpr char beginOfArray = '\x9f'; // both of those without a length

} // namespace

std::optional<WireValue> CborContent::parse(const QByteArray &item, WireError *error) const {
    return WireValue::parseCbor(item, error, limits());
}

QByteArray CborContent::written(const Outgoing &message, std::optional<QString> &path) {
    CborWriter writer;
    message.write(writer);
    if (writer.hasRefused())
        path = writer.refused();
    return writer.take();
}

void CborContent::joinItems(std::vector<QByteArray> &items) {
    items.front().prepend(beginOfArray);
    items.back().append(endOfContainer);
}

// The params come last, and have an end, as has the whole: the other two go before these ends.
QByteArray CborContent::withSubscription(QByteArray notification, quint64 subscription, quint64 dropped) {
    QByteArray more;
    QCborStreamWriter writer(&more);
    writer.append(QLatin1String("subscription"));
    writer.append(subscription);
    writer.append(QLatin1String("dropped"));
    writer.append(dropped);
    notification.chop(2);
    return notification.append(more).append(endOfContainer).append(endOfContainer);
}

} // namespace hermes
