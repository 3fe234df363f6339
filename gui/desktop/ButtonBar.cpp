#include "gui/desktop/ButtonBar.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "gui/desktop/widgets/ValueEditor.h"

#include <QEvent>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <utility>

namespace hermes::desktop {
namespace {

/// One line, scrolled where there are more buttons than fit; the focus brings them into sight.
class LineScroll : public QScrollArea {
public:
    explicit LineScroll(QWidget *line) {
        setWidget(line);
        setWidgetResizable(true);
        setFrameShape(QFrame::NoFrame);
        setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        setFocusPolicy(Qt::NoFocus);
        setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Fixed);
    }
    QSize sizeHint() const override {
        const QSize line = widget()->sizeHint();
        const bool isScrolled = line.width() > width();
        return {line.width(), line.height() + (isScrolled ? horizontalScrollBar()->sizeHint().height() : 0)};
    }
    QSize minimumSizeHint() const override { return {100, sizeHint().height()}; }

protected:
    void resizeEvent(QResizeEvent *event) override {
        QScrollArea::resizeEvent(event);
        updateGeometry();
    }
    bool eventFilter(QObject *watched, QEvent *event) override {
        if (event->type() == QEvent::LayoutRequest)
            updateGeometry(); // of the line, which is as high as its buttons
        return QScrollArea::eventFilter(watched, event);
    }
};

QString explanation(const Macro &macro) {
    QStringList lines;
    for (const MacroStep &step : macro.steps) {
        lines.append(ButtonBar::tr("%1 (%2)").arg(step.title(), step.robot));
        if (step.pause_s > 0 && &step != &macro.steps.back())
            lines.append(ButtonBar::tr("wait %1 s").arg(step.pause_s));
        if (lines.size() > 12) {
            lines.append("...");
            break;
        }
    }
    return lines.join('\n');
}

} // namespace

ButtonBar::ButtonBar(Fleet &fleet, const Buttons &buttons, MacroRunner &runner, QWidget *parent)
    : QWidget(parent)
    , buttons_(buttons)
    , runner_(runner)
    , line_(inRow({Part::room()}))
    , end_(named(new QPushButton(theme::icon("stop"), tr("End")), "endMacro",
                 tr("Ends what runs here; what the robot has begun goes on. STOP ends it, too.")))
    , text_(named(new PlainLabel, "macroText")) {
    setObjectName("buttonLine");
    auto *const edit = named(new QPushButton(tr("Edit...")), "editButtons",
                             tr("Names, order and commands of these buttons"));
    text_->setWordWrap(true);
    text_->setMinimumSize(36 * fontMetrics().averageCharWidth(), 2 * fontMetrics().lineSpacing());
    text_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
    setLayout(inRow({new LineScroll(filled(new QWidget, line_)), {text_, 1}, end_, edit}));
    layout()->setContentsMargins(4, 0, 4, 0);

    refresh_.setSingleShot(true);
    refresh_.setInterval(50);
    connect(edit, &QPushButton::clicked, this, &ButtonBar::editWanted);
    connect(end_, &QPushButton::clicked, this, [this] { runner_.end(tr("by hand")); });
    connect(&buttons, &Buttons::changed, this, &ButtonBar::rebuild);
    connect(&runner, &MacroRunner::changed, this, &ButtonBar::update);
    connect(&second_, &SecondPress::changed, this, &ButtonBar::update);
    connect(&fleet, &Fleet::changed, &refresh_, [this] {
        if (!refresh_.isActive())
            refresh_.start();
    });
    connect(&refresh_, &QTimer::timeout, this, &ButtonBar::update);
    rebuild();
}

void ButtonBar::rebuild() {
    for (QPushButton *const button : std::exchange(made_, {}))
        discard(button);
    asked_ = -1;
    second_.forget();
    QWidgetList order;
    for (int i = 0; i < int(buttons_.all().size()); ++i) {
        auto *const button = named(new QPushButton, QString("macro%1").arg(i));
        connect(button, &QPushButton::clicked, this, [this, i] { press(i); });
        line_->insertWidget(i, button);
        made_.push_back(button);
        order.append(button);
    }
    order.append(end_);
    chainFocus(order);
    update();
}

// Texts stay as they are: a button beside would move under the mouse.
void ButtonBar::update() {
    for (std::size_t i = 0; i < made_.size(); ++i) {
        const Macro &macro = buttons_.all()[i];
        const QString hindrance = runner_.hindrance(macro);
        made_[i]->setText(labelText(macro.name));
        made_[i]->setIcon(runner_.away(macro).isEmpty() ? theme::icon("call")
                                                        : theme::icon(Condition::Unreachable));
        made_[i]->setEnabled(hindrance.isEmpty() && !runner_.isRunning());
        made_[i]->setToolTip(toolTipOf(hindrance.isEmpty() ? explanation(macro) : hindrance));
    }
    end_->setEnabled(runner_.isRunning());
    if (!second_.isAwaited())
        return tell(runner_.text(), runner_.hasFailed() ? Condition::Fault : Condition::Ready);
    const Macro &macro = buttons_.all().at(std::size_t(asked_));
    tell(tr("Press %1 once more: it replaces or forgets %2")
             .arg(macro.name, runner_.destroys(macro).join(", ")),
         Condition::Warning);
}

void ButtonBar::tell(const QString &text, Condition condition) {
    text_->setText(text);
    text_->setToolTip(toolTipOf(text));
    const QString style =
        condition == Condition::Ready ? QString() : "color: " + theme::colour(condition).name() + ';';
    if (style != text_->styleSheet())
        text_->setStyleSheet(style);
}

void ButtonBar::press(int place) {
    const Macro macro = buttons_.all().at(std::size_t(place));
    if (std::exchange(asked_, place) != place)
        second_.forget();
    if (runner_.destroys(macro).isEmpty() || second_.press())
        runner_.run(macro);
}

} // namespace hermes::desktop
