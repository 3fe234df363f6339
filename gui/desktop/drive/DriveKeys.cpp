#include "gui/desktop/drive/DriveKeys.h"

#include "gui/desktop/widgets/Typing.h"

#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QApplication>
#include <QComboBox>
#include <QDialog>
#include <QPlainTextEdit>
#include <QTextEdit>

namespace hermes::desktop {
namespace {

constexpr double slow = 0.3;
constexpr qint64 rest_ms = 150;   // what is pressed sooner after its release is held, and repeated
constexpr qint64 unseen_ms = 300; // what the display does not say to be held for so long is not
constexpr auto chord = Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier;

/// Widgets that need arrows or letters themselves.
bool usesKeys(const QWidget *focus) {
    return QApplication::activePopupWidget() || isTyping(focus) ||
           qobject_cast<const QAbstractItemView *>(focus) || qobject_cast<const QComboBox *>(focus) ||
           qobject_cast<const QAbstractSlider *>(focus) || qobject_cast<const QPlainTextEdit *>(focus) ||
           qobject_cast<const QTextEdit *>(focus);
}

bool isDriveKey(int key) {
    static const QSet<int> keys{Qt::Key_Up, Qt::Key_Down, Qt::Key_Left, Qt::Key_Right, Qt::Key_W,
                                Qt::Key_A,  Qt::Key_S,    Qt::Key_D,    Qt::Key_Q,     Qt::Key_E};
    return keys.contains(key);
}

/// The key itself, whatever letter it has: of two layouts, or while another key changes its letter. Events
/// that no keyboard has sent know the letter only.
qint64 idOf(const QKeyEvent &key) {
    return key.nativeScanCode() ? qint64(key.nativeScanCode()) : -qint64(key.key());
}

} // namespace

DriveKeys::DriveKeys(DriveControl &drive, const TypingWatch &typing, QWidget &window)
    : QObject(&window)
    , drive_(drive)
    , window_(window)
    , typing_(typing) {
    asking_.setTimerType(Qt::PreciseTimer);
    connect(&asking_, &QTimer::timeout, this, &DriveKeys::ask);
    qApp->installEventFilter(this);
}

bool DriveKeys::eventFilter(QObject *watched, QEvent *event) {
    const auto *const widget = qobject_cast<QWidget *>(watched);
    const bool isOurs =
        widget && (widget == &window_ || (widget->isWindow() && widget->parentWidget() == &window_));
    if (isOurs && (event->type() == QEvent::WindowDeactivate || event->type() == QEvent::Close))
        letGo(); // floating panels drive, too
    if (event->type() == QEvent::Show && widget && widget->windowType() == Qt::Popup && !down_.isEmpty())
        letGo(); // a menu or a list has the keys now
    if (event->type() == QEvent::KeyRelease || event->type() == QEvent::KeyPress) {
        // Wherever it is heard: what is let go drives no more, and what was held when the drive ended is no
        // key of a menu or a dialog.
        const auto *const key = static_cast<QKeyEvent *>(event);
        const bool isRelease = event->type() == QEvent::KeyRelease;
        if (!key->isAutoRepeat() && isRelease && down_.remove(idOf(*key))) {
            steer(key->modifiers());
            return true;
        }
        if (isRepeat(*key) && stale_.contains(idOf(*key)))
            return true;
        if (!isRelease && !isRepeat(*key))
            stale_.remove(idOf(*key));
        if (!key->isAutoRepeat() && isRelease)
            noteRelease(*key);
    }
    if (!widget || (widget->window() != &window_ && widget->window()->parentWidget() != &window_) ||
        qobject_cast<const QDialog *>(widget->window()))
        return false; // a dialog has its keys for itself
    if (event->type() == QEvent::ShortcutOverride) {
        // Else a shortcut of the same key would come first.
        const auto *const key = static_cast<QKeyEvent *>(event);
        if (isDriveKey(key->key()) && !(key->modifiers() & chord) && !usesKeys(QApplication::focusWidget()))
            event->accept();
        return false;
    }
    if (event->type() != QEvent::KeyPress && event->type() != QEvent::KeyRelease)
        return false;
    const auto *const key = static_cast<QKeyEvent *>(event);
    if (event->type() == QEvent::KeyPress)
        return press(*key);
    if (key->isAutoRepeat())
        return down_.contains(idOf(*key));
    steer(key->modifiers()); // Shift
    return false;
}

// Not each display says it, and some tell a release and a press for each repeat.
bool DriveKeys::isRepeat(const QKeyEvent &key) const {
    if (key.isAutoRepeat())
        return true;
    const auto released = released_.constFind(idOf(key));
    return key.type() == QEvent::KeyPress && released != released_.constEnd() &&
           ((key.timestamp() != 0 && key.timestamp() == released->stamp) ||
            !released->age.hasExpired(rest_ms));
}

void DriveKeys::noteRelease(const QKeyEvent &key) {
    Release &release = released_[idOf(key)];
    release.stamp = key.timestamp();
    release.age.start();
}

// A key that was held before the drive keys were the window's begins no drive.
bool DriveKeys::press(const QKeyEvent &key) {
    if (key.key() == Qt::Key_Shift) {
        steer(key.modifiers() | Qt::ShiftModifier);
        return false;
    }
    if (!isDriveKey(key.key()) || (key.modifiers() & chord) || typing_.isCutOff())
        return false;
    if (const QWidget *const focus = QApplication::focusWidget(); usesKeys(focus)) {
        const bool isLetter = key.key() < Qt::Key_Escape; // arrows are meant for it
        if (!isLetter || QApplication::activePopupWidget() || isTyping(focus))
            return false;
        if (!isRepeat(key))
            Q_EMIT drivesNothing();
        return true; // else it would choose what begins with it, maybe another robot
    }
    if (!isRepeat(key))
        hold(key);
    steer(key.modifiers());
    return true;
}

void DriveKeys::hold(const QKeyEvent &key) {
    if (held_.canAsk() && !asking_.isActive()) {
        held_.begin();
        asking_.start(DriveControl::period);
    }
    Held &held = down_[idOf(key)];
    held.key = key.key();
    held.seen.start();
}

void DriveKeys::ask() {
    const bool isAnswered = held_.ask(window_);
    if (down_.isEmpty())
        return asking_.stop();
    if (held_.isLayoutChanged())
        return letGo(tr("The drive has ended: the layout of the keyboard has changed."));
    for (auto held = down_.begin(); held != down_.end(); ++held) {
        if (held.key() < 0 || (isAnswered && held_.isDown(quint32(held.key()))))
            held->seen.start();
        else if (held->seen.hasExpired(unseen_ms))
            return letGo(tr("The drive has ended: the display does not say that its key is held."));
    }
}

void DriveKeys::steer(Qt::KeyboardModifiers modifiers) {
    const auto isDown = [this](int key) {
        return std::any_of(down_.begin(), down_.end(), [&](const Held &held) { return held.key == key; });
    };
    const auto either = [&](int one, int other) { return double(isDown(one) || isDown(other)); };
    const double share = modifiers & Qt::ShiftModifier ? slow : 1;
    const double ahead = either(Qt::Key_Up, Qt::Key_W) - either(Qt::Key_Down, Qt::Key_S);
    const double left = either(Qt::Key_Left, Qt::Key_A) - either(Qt::Key_Right, Qt::Key_D);
    const double turn = double(isDown(Qt::Key_Q)) - double(isDown(Qt::Key_E));
    drive_.steer("keys", {share * ahead, share * left, share * turn}, !down_.isEmpty());
}

void DriveKeys::letGo(const QString &reason) {
    for (auto held = down_.keyBegin(); held != down_.keyEnd(); ++held)
        stale_.insert(*held);
    down_.clear();
    drive_.steer("keys", {}, false);
    drive_.halt(reason);
}

} // namespace hermes::desktop
