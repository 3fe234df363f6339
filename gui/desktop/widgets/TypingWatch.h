#pragma once

#include <QElapsedTimer>
#include <QObject>

namespace hermes::desktop {

/// Sees when a field vanishes under the hands of who types: what is typed on is meant for nobody, and is no
/// drive key or Enter until a press of the mouse, Tab, or a second without a key.
class TypingWatch : public QObject {
    Q_OBJECT
public:
    explicit TypingWatch(QObject *parent);

    bool isCutOff() const { return isCutOff_ && lastKey_.elapsed() < pause_ms; }

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    static constexpr qint64 pause_ms = 1000;

    bool isTyping_ = false; ///< the last key was a letter in a field
    bool isCutOff_ = false;
    QElapsedTimer lastKey_;
};

} // namespace hermes::desktop
