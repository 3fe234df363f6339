#include "gui/desktop/panels/ReplayBar.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QCheckBox>
#include <QComboBox>
#include <QEvent>
#include <QPushButton>
#include <QScrollArea>
#include <QTimer>
#include <QToolButton>

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr double speeds[]{0.25, 0.5, 1, 2, 5, 10};
constexpr double justPassed_s = 1; // a second press goes to the mark before that

QToolButton *makeButton(const char *name, const char *icon) {
    auto *const button = named(new QToolButton, name);
    button->setIcon(theme::icon(icon));
    return button;
}

} // namespace

ReplayBar::ReplayBar(Sessions &sessions, QWidget *parent)
    : QWidget(parent)
    , sessions_(sessions)
    , position_(named(new PlainLabel, "position"))
    , line_(named(new Timeline, "timeline"))
    , pause_(named(new QPushButton, "pauseReplay", tr("The replay waits, or goes on")))
    , before_(makeButton("markBefore", "mark-before"))
    , after_(makeButton("markAfter", "mark-after"))
    , speed_(named(new QComboBox, "replaySpeed"))
    , loop_(named(new QCheckBox(tr("Loop")), "loopReplay", tr("At its end the replay begins anew"))) {
    position_->setMinimumWidth(1);
    speed_->setAccessibleName(tr("Speed of the replay"));
    for (const double speed : speeds)
        speed_->addItem(tr("%1 x").arg(speed), speed);
    speed_->addItem(tr("fastest"), 0.0);
    filled(this,
           inColumn({inRow({{position_, 1}, loop_}), line_, inRow({before_, {pause_, 1}, after_, speed_})}));

    connect(&sessions, &Sessions::changed, this, &ReplayBar::update);
    connect(line_, &Timeline::heldChanged, this, &ReplayBar::hold);
    connect(line_, &Timeline::sought, this, [this](double t_s) {
        sessions_.order("session.seek", {{"t_s", t_s}});
        showPosition();
    });
    connect(pause_, &QPushButton::clicked, this, [this] {
        sessions_.order("session.pause", {{"paused", !isPaused_}});
    });
    connect(before_, &QToolButton::clicked, this, [this] { goTo(markBefore()); });
    connect(after_, &QToolButton::clicked, this, [this] { goTo(markAfter()); });
    connect(speed_, QOverload<int>::of(&QComboBox::activated), this, [this] {
        sessions_.order("session.speed", {{"speed", speed_->currentData().toDouble()}});
    });
    connect(loop_, &QCheckBox::clicked, this, [this](bool isOn) {
        sessions_.order("session.loop", {{"loop", isOn}});
    });
    update();
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

/// What waits for an answer is shown as it was set.
void ReplayBar::update() {
    const SessionState &now = sessions_.state();
    const SessionReplay replay = now.replay.value_or(SessionReplay());
    line_->setDuration(replay.duration_s);
    if (!sessions_.isOrdered("session.seek"))
        line_->setPosition(replay.position_s);
    std::vector<Timeline::Mark> marks;
    for (const SessionMark &mark : now.marks)
        marks.push_back({mark.t_s, shortLine(mark.text, longestName)});
    line_->setMarks(std::move(marks));
    isPaused_ = line_->isHeld() ? wasPaused_ : replay.paused;
    pause_->setText(isPaused_ ? tr("Go on") : tr("Pause"));
    pause_->setIcon(theme::icon(isPaused_ ? "start" : "pause"));
    if (!sessions_.isOrdered("session.speed"))
        showSpeed(replay.speed);
    if (!sessions_.isOrdered("session.loop"))
        loop_->setChecked(replay.loop);
    showPosition();
    setVisible(now.replay.has_value());
}

/// One that others have set may be none of these.
void ReplayBar::showSpeed(double speed) {
    constexpr int other = int(std::size(speeds)) + 1;
    if (speed_->findData(speed) < 0)
        speed_->insertItem(other, tr("%1 x").arg(shortNumber(speed, 2)), speed);
    speed_->setCurrentIndex(speed_->findData(speed));
    while (speed_->count() > other + (speed_->currentIndex() == other))
        speed_->removeItem(speed_->count() - 1);
}

void ReplayBar::showPosition() {
    const QString position = durationText(line_->position_s());
    position_->setText(
        line_->duration_s() > 0 ? tr("%1 of %2").arg(position, durationText(line_->duration_s())) : position);
    const auto tell = [this](QAbstractButton *button, const Timeline::Mark *mark, const QString &none) {
        const QString text =
            mark ? tr("To the mark \"%1\" at %2").arg(mark->text, durationText(mark->t_s)) : none;
        button->setEnabled(mark);
        button->setToolTip(toolTipOf(text));
        button->setAccessibleName(text);
    };
    tell(before_, markBefore(), tr("There is no mark before this"));
    tell(after_, markAfter(), tr("There is no mark after this"));
}

/// The replay waits while the mouse moves along it.
void ReplayBar::hold(bool isHeld) {
    if (isHeld)
        wasPaused_ = isPaused_;
    if (sessions_.state().replay) // else it has ended meanwhile
        sessions_.order("session.pause", {{"paused", isHeld || wasPaused_}});
}

const Timeline::Mark *ReplayBar::markBefore() const {
    const auto &marks = line_->marks();
    const double limit_s = line_->position_s() - (isPaused_ ? 0.01 : justPassed_s);
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
