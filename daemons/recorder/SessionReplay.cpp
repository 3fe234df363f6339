// The replay of a session.
#include "common/schema/SchemaValidator.h"
#include "daemons/recorder/SessionControl.h"

namespace hermes::recorder {

Result<void> SessionControl::mayReplay() const {
    return isBusy()
               ? Result<void>(Error(ErrorCode::NotReady,
                                    QString("\"%1\" is being recorded; session.stop ends it").arg(now_.name)))
               : Result<void>();
}

void SessionControl::replay(const QString &name, const SessionPlayer::Options &options,
                            const Done<SessionState> &done) {
    if (const Result<void> fine = mayReplay(); !fine)
        return done(fine.error());
    if (isReplaying())
        return live([=](const auto &) { replay(name, options, done); });
    find(name, [=](const Result<RecordedSession> &session) {
        const Result<void> fine = session ? mayReplay() : session.error(); // others have begun meanwhile
        if (!fine)
            return done(fine.error());
        if (isReplaying())
            return replay(name, options, done);
        if (options.from_s > session->duration_s)
            return done(invalidParams({{"from_s", options.from_s, "a time of the session"}},
                                      QString("from_s is %1 s, expected at most the %2 s of the session")
                                          .arg(options.from_s)
                                          .arg(session->duration_s, 0, 'f', 1)));
        forget(session->name);
        now_.session = session->id;
        now_.start = session->start;
        position_s_ = length_s_ = 0;
        player_.play(*session, options);
        Q_EMIT changed();
        done(state());
    });
}

void SessionControl::setMarks(const std::vector<SessionMark> &marks) {
    now_.marks = marks;
    Q_EMIT changed();
}

void SessionControl::live(const Done<SessionState> &done) {
    if (!isReplaying())
        return done(state());
    toBeLive_.push_back(done);
    player_.end();
}

bool SessionControl::isOf(const RecordedSession &session) const {
    return (isBusy() && session.id == now_.session) || (isReplaying() && player_.session().id == session.id);
}

} // namespace hermes::recorder
