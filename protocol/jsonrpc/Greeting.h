#pragma once

#include <QByteArray>
#include <QString>

namespace hermes {

/// What the first bytes of a connection tell of who speaks. A web page can have a browser send requests to
/// any port of the operator's computer, with lines of its own in their body; none of these may be taken for a
/// message.
class Greeting {
public:
    enum class Speaker { Unknown, Ours, Http, Tls };

    /// Takes bytes as they arrive, split anywhere, until the speaker is known.
    Speaker look(const QByteArray &bytes);
    Speaker speaker() const { return speaker_; }
    bool isForeign() const { return speaker_ >= Speaker::Http; }
    /// A sentence for people.
    QString reason() const;

private:
    enum class Place { Start, Record, Method, Target, Rest };

    Speaker next(char byte);
    bool endsInVersion() const;

    Speaker speaker_ = Speaker::Unknown;
    Place place_ = Place::Start;
    char tail_[9] = {}; // of the first line: as long as " HTTP/1.1"
};

} // namespace hermes
