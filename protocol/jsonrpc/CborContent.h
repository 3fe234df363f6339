#pragma once

#include "protocol/jsonrpc/Codec.h"

namespace hermes {

/// A framing whose messages are items of CBOR; arrays of numbers are typed arrays. The functions here are of
/// items without what a frame adds to them.
class CborContent : public Codec {
protected:
    using Codec::Codec;

    std::optional<WireValue> parse(const QByteArray &item, WireError *error) const override;
    static QByteArray written(const Outgoing &message, std::optional<QString> &path);
    /// Items become the pieces of an array of them.
    static void joinItems(std::vector<QByteArray> &items);
    static QByteArray withSubscription(QByteArray notification, quint64 subscription, quint64 dropped);
};

} // namespace hermes
