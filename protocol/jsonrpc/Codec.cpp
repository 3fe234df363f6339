#include "protocol/jsonrpc/Codec.h"

#include "protocol/jsonrpc/CborCodec.h"
#include "protocol/jsonrpc/JsonCodec.h"
#include "protocol/jsonrpc/SerialCodec.h"

#include <stdexcept>

namespace hermes {
namespace {

struct Kind {
    QString name;
    CodecMaker make;
};

std::vector<Kind> &kinds() {
    // A new framing is one line here.
    static std::vector<Kind> all = {
        {QStringLiteral("json"), makeCodecOf<JsonCodec>},
        {QStringLiteral("cbor"), makeCodecOf<CborCodec>},
        {QStringLiteral("serial"), makeCodecOf<SerialCodec>},
    };
    return all;
}

} // namespace

std::vector<CodecFrame> Codec::split(const QByteArray &bytes) {
    if (watches_)
        greeting_.look(bytes);
    return greeting_.isForeign() ? std::vector<CodecFrame>() : splitFrames(bytes);
}

CodecItem Codec::read(const CodecFrame &frame) const {
    if (frame.error)
        return {QJsonValue::Undefined, frame.error, {}};
    WireError error;
    if (const auto value = parse(frame.bytes, &error))
        return itemOf(*value);
    return {QJsonValue::Undefined,
            RpcError(ErrorCode::ParseError,
                     QStringLiteral("parse error at byte %1: %2").arg(error.offset).arg(error.message)),
            {}};
}

void Codec::reset() {
    greeting_ = {};
    forgetFrame();
}

void Codec::succeed(const Codec &other) {
    counts_ = other.counts_;
    limit_ = other.limit_;
    inFrame_ = other.inFrame_;
    greeting_ = other.greeting_;
    watches_ = other.watches_;
}

std::vector<CodecItem> Codec::feed(const QByteArray &bytes) {
    std::vector<CodecItem> items;
    for (const CodecFrame &frame : split(bytes)) {
        items.push_back(read(frame));
        count(items.back());
    }
    return items;
}

CodecItem Codec::itemOf(const WireValue &value) {
    const WireView params = value["params"];
    const bool isTopic = value["method"].text() == QStringLiteral("topic");
    const WireView data = isTopic ? params["data"] : WireView();
    if (data.kind() == WireView::Kind::Undefined)
        return {value.toJson(), std::nullopt, {}};
    QJsonObject message, rest;
    params.forEachMember([&](const QString &name, WireView member) {
        if (name != QStringLiteral("data"))
            rest.insert(name, member.toJson());
    });
    value.forEachMember([&](const QString &name, WireView member) {
        message.insert(name, name == QStringLiteral("params") ? QJsonValue(rest) : member.toJson());
    });
    return {message, std::nullopt, WireValue(value, data)};
}

void Codec::count(const CodecItem &item) {
    if (!item.error)
        ++counts_.messagesIn;
    else if (item.error->is(ErrorCode::OverLimit))
        ++counts_.oversized;
    else
        ++counts_.malformed;
}

EncodedFrame Codec::encode(const Outgoing &message) {
    std::optional<QString> path;
    const QByteArray bytes = frame(message, path);
    if (path) {
        ++counts_.refused;
        return {{},
                RpcError(ErrorCode::InternalError,
                         QStringLiteral("cannot send %1: not a finite number")
                             .arg(path->isEmpty() ? QStringLiteral("the message") : *path))};
    }
    ++counts_.messagesOut;
    return {bytes, std::nullopt};
}

EncodedFrame Codec::encodeTopic(const QString &topic, quint64 seq, double stamp, const Outgoing &data,
                                bool replayed) {
    return encode(Outgoing::writtenBy([&](WireWriter &out) {
        out.beginObject();
        out.key(QStringLiteral("jsonrpc"));
        out.text(QStringLiteral("2.0"));
        out.key(QStringLiteral("method"));
        out.text(QStringLiteral("topic"));
        out.key(QStringLiteral("params"));
        out.beginObject();
        out.key(QStringLiteral("topic"));
        out.text(topic);
        out.key(QStringLiteral("seq"));
        out.integer(qint64(seq));
        out.key(QStringLiteral("stamp"));
        out.number(stamp);
        if (out.hasRefused())
            return out.within(QStringLiteral("params.stamp"));
        if (replayed) {
            out.key(QStringLiteral("replayed"));
            out.boolean(true);
        }
        out.key(QStringLiteral("data"));
        data.write(out);
        if (out.hasRefused()) {
            out.within(QStringLiteral("data"));
            return out.within(QStringLiteral("params"));
        }
        out.endObject();
        out.endObject();
    }));
}

bool addCodec(const QString &name, CodecMaker make) {
    if (codecNames().contains(name))
        throw std::invalid_argument("codec " + name.toStdString() + ": there is one of that name");
    kinds().push_back({name, make});
    return true;
}

std::unique_ptr<Codec> makeCodec(const QString &name) {
    for (const Kind &kind : kinds()) {
        if (name == kind.name)
            return kind.make();
    }
    return nullptr;
}

QStringList codecNames() {
    QStringList names;
    for (const Kind &kind : kinds())
        names.append(kind.name);
    return names;
}

} // namespace hermes
