#pragma once

#include <QByteArray>

namespace hermes::web {

/// A binary frame that a client sent.
struct ClientFrame {
    enum class Kind { Bad, Message, Call };

    Kind kind = Kind::Bad;
    quint32 id = 0;   ///< of the client's channel, or of a service
    quint32 call = 0; ///< that the answer names
    QByteArray encoding, content;

    static ClientFrame parse(const QByteArray &bytes);
};

/// A message of a topic; id: of the client's subscription.
QByteArray messageFrame(quint32 id, double stamp, const QByteArray &json);
/// The answer to a call of a service.
QByteArray answerFrame(quint32 service, quint32 call, const QByteArray &json);

} // namespace hermes::web
