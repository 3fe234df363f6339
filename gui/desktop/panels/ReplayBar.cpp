#include "gui/desktop/panels/ReplayBar.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QPushButton>
#include <QScrollArea>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr double speeds[]{0.25, 0.5, 1, 2, 5, 10};
constexpr double justPassed_s = 1; // a second press goes to the mark before that

QToolButton *makeButton(const char *name, const char *icon) {
    auto *const button = new QToolButton;
    button->setObjectName(name);
    button->setIcon(theme::icon(icon));
    return button;
}

} // namespace

ReplayBar::ReplayBar(SessionPlayer &player, QWidget *parent)
    : QWidget(parent)
    , player_(player)
    , position_(new PlainLabel)
    , line_(new Timeline)
    , pause_(new QPushButton)
    , before_(makeButton("markBefore", "mark-before"))
    , after_(makeButton("markAfter", "mark-after"))
    , speed_(new QComboBox)
    , loop_(new QCheckBox(tr("Loop"))) {
    position_->setObjectName("position");
    position_->setMinimumWidth(1);
    line_->setObjectName("timeline");
    pause_->setObjectName("pauseReplay");
    pause_->setToolTip(tr("All loggers of the recording wait, or go on"));
    speed_->setObjectName("replaySpeed");
    speed_->setAccessibleName(tr("Speed of the replay"));
    for (const double speed : speeds)
        speed_->addItem(tr("%1 x").arg(speed), speed);
    speed_->addItem(tr("fastest"), 0.0);
    loop_->setObjectName("loopReplay");
    loop_->setToolTip(tr("At its end the recording begins anew"));
    layOut();
    showPosition();
    showPaused();
    hide();

    connect(&player, &SessionPlayer::progress, this, &ReplayBar::showProgress);
    connect(&player, &SessionPlayer::ended, this, &ReplayBar::hide);
    connect(line_, &Timeline::heldChanged, this, &ReplayBar::hold);
    connect(line_, &Timeline::sought, this, [this](double t_s) {
        player_.seek(t_s);
        showPosition();
    });
    connect(pause_, &QPushButton::clicked, this, [this] {
        player_.setPaused(!player_.isPaused());
        showPaused();
    });
    connect(before_, &QToolButton::clicked, this, [this] { goTo(markBefore()); });
    connect(after_, &QToolButton::clicked, this, [this] { goTo(markAfter()); });
    connect(speed_, QOverload<int>::of(&QComboBox::activated), this,
            [this] { player_.setSpeed(speed_->currentData().toDouble()); });
    connect(loop_, &QCheckBox::toggled, this, [this](bool isOn) { player_.setLoop(isOn); });
}

void ReplayBar::layOut() {
    auto *const top = new QHBoxLayout;
    top->addWidget(position_, 1);
    top->addWidget(loop_);
    auto *const bottom = new QHBoxLayout;
    bottom->addWidget(before_);
    bottom->addWidget(pause_, 1);
    bottom->addWidget(after_);
    bottom->addWidget(speed_);
    auto *const layout = new QVBoxLayout(this);
    layout->setContentsMargins({});
    layout->addLayout(top);
    layout->addWidget(line_);
    layout->addLayout(bottom);
}

/// On a low screen the panel is scrolled, also when it becomes low afterwards.
void ReplayBar::showEvent(QShowEvent *event) {
    QWidget::showEvent(event);
    for (QWidget *above = parentWidget(); above; above = above->parentWidget())
        if (auto *const area = qobject_cast<QScrollArea *>(above))
            area->viewport()->installEventFilter(this);
    comeInSight();
}

bool ReplayBar::eventFilter(QObject *viewport, QEvent *event) {
    if (event->type() == QEvent::Resize)
        comeInSight();
    return QWidget::eventFilter(viewport, event);
}

void ReplayBar::comeInSight() {
    QTimer::singleShot(0, this, [this] { // when it has its place
        for (QWidget *above = parentWidget(); above && isVisible(); above = above->parentWidget())
            if (auto *const area = qobject_cast<QScrollArea *>(above))
                area->ensureWidgetVisible(this);
    });
}

void ReplayBar::begin(const RecordedSession &session) {
    recorded_s_ = session.end - session.start;
    line_->setMarks({});
    line_->setDuration(0);
    speed_->setCurrentIndex(speed_->findData(1.0));
    loop_->setChecked(false);
}

void ReplayBar::setMarks(const std::vector<SessionMark> &marks) {
    std::vector<Timeline::Mark> shown;
    for (const SessionMark &mark : marks)
        shown.push_back({mark.t_s, shortLine(mark.text, longestName)});
    line_->setMarks(std::move(shown));
    showPosition();
}

void ReplayBar::showProgress(double position_s, double duration_s) {
    const bool canSeek = player_.canSeek();
    line_->setDuration(duration_s > 0 ? duration_s : recorded_s_); // until they have read it through
    line_->setPosition(position_s);
    line_->setEnabled(canSeek);
    line_->setToolTip(canSeek ? QString() : tr("One of the loggers can only play it from its beginning"));
    const bool canSetSpeed = player_.canSetSpeed();
    speed_->setEnabled(canSetSpeed);
    speed_->setToolTip(canSetSpeed
                           ? tr("How many times faster than it was recorded; \"fastest\": as fast as the "
                                "loggers can")
                           : tr("One of the loggers cannot change its speed while it plays"));
    showPosition();
    showPaused();
    show();
}

void ReplayBar::showPosition() {
    const QString position = durationText(line_->position_s());
    position_->setText(
        line_->duration_s() > 0 ? tr("%1 of %2").arg(position, durationText(line_->duration_s())) : position);
    const auto tell = [this](QAbstractButton *button, const Timeline::Mark *mark, const QString &none) {
        const QString text =
            mark ? tr("To the mark \"%1\" at %2").arg(mark->text, durationText(mark->t_s)) : none;
        button->setEnabled(mark && line_->isEnabled());
        button->setToolTip(toolTipOf(text));
        button->setAccessibleName(text);
    };
    tell(before_, markBefore(), tr("There is no mark before this"));
    tell(after_, markAfter(), tr("There is no mark after this"));
}

void ReplayBar::showPaused() {
    const bool isPaused = line_->isHeld() ? wasPaused_ : player_.isPaused();
    pause_->setText(isPaused ? tr("Go on") : tr("Pause"));
    pause_->setIcon(theme::icon(isPaused ? "start" : "pause"));
}

/// The recording waits while the mouse moves along it.
void ReplayBar::hold(bool isHeld) {
    if (isHeld)
        wasPaused_ = player_.isPaused();
    player_.setPaused(isHeld || wasPaused_);
}

const Timeline::Mark *ReplayBar::markBefore() const {
    const auto &marks = line_->marks();
    const double limit_s = line_->position_s() - (player_.isPaused() ? 0.01 : justPassed_s);
    const auto found = std::find_if(marks.rbegin(), marks.rend(),
                                    [limit_s](const Timeline::Mark &mark) { return mark.t_s < limit_s; });
    return found == marks.rend() ? nullptr : &*found;
}

const Timeline::Mark *ReplayBar::markAfter() const {
    const double limit_s = line_->position_s() + 0.01;
    for (const Timeline::Mark &mark : line_->marks())
        if (mark.t_s > limit_s && mark.t_s <= line_->duration_s())
            return &mark;
    return nullptr;
}

void ReplayBar::goTo(const Timeline::Mark *mark) {
    if (mark)
        line_->take(mark->t_s);
}

} // namespace hermes::desktop
