#pragma once

#include <QCborStreamWriter>
#include <QtEndian>

namespace hermes {

/// One item of CBOR that says what the text of JSON does, token by token: as deep, as large, and as wrong.
inline QByteArray asCbor(const QByteArray &json) {
    const auto inText = [&json](int quote) { // the end of the text that begins there
        int end = quote + 1;
        while (end < json.size() && json[end] != '"')
            end += json[end] == '\\' ? 2 : 1;
        return qMin(end + 1, json.size());
    };
    QByteArray cbor;
    const auto put = [&cbor](const auto &value) {
        QByteArray item;
        QCborStreamWriter(&item).append(value);
        cbor += item;
    };
    for (int at = 0; at < json.size();) {
        const char first = json[at];
        if (first == '"') {
            const int end = inText(at);
            const QByteArray list = '[' + json.mid(at, end - at) + ']';
            put(QJsonDocument::fromJson(list).array().at(0).toString());
            at = end;
            continue;
        }
        if (const int place = QByteArray("[{]}").indexOf(first); place >= 0)
            cbor.append("\x9f\xbf\xff\xff"[place]);
        if (QByteArray("[{]},: \r\n").contains(first)) {
            ++at;
            continue;
        }
        int end = at;
        while (end < json.size() && !QByteArray(",:]} \r\n").contains(json[end]))
            ++end;
        const QByteArray word = json.mid(at, end - at);
        bool isWhole = false;
        const qint64 whole = word.toLongLong(&isWhole);
        if (word == "null")
            put(nullptr);
        else if (word == "true" || word == "false")
            put(word == "true");
        else if (isWhole)
            put(whole);
        else
            put(word.toDouble());
        at = end;
    }
    return cbor;
}

/// The same as a frame.
inline QByteArray asCborFrame(const QByteArray &json) {
    const QByteArray item = asCbor(json);
    QByteArray frame(4, Qt::Uninitialized);
    qToBigEndian(quint32(item.size()), frame.data());
    return frame + item;
}

} // namespace hermes
