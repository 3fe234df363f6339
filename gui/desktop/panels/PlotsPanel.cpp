#include "gui/desktop/panels/PlotsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/MessageView.h"
#include "gui/desktop/panels/PlotSets.h"
#include "gui/desktop/panels/PlotSuggestions.h"
#include "gui/desktop/panels/TopicTree.h"
#include "gui/desktop/view/PlotPane.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/desktop/widgets/ScrolledPanel.h"
#include "gui/desktop/widgets/Seen.h"

#include <QHBoxLayout>
#include <QMenu>
#include <QPushButton>
#include <QSplitter>
#include <QStackedWidget>
#include <QToolButton>

namespace hermes::desktop {

PlotsPanel::PlotsPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , board_(new PlotBoard(fleet))
    , tree_(new TopicTree(fleet, [this](const FieldId &field) { return board_->has(field); }))
    , message_(new MessageLabel)
    , newest_(new MessageView)
    , suggestions_(new PlotSuggestions(fleet))
    , sets_(new PlotSets(this))
    , pages_(new QStackedWidget) {
    layOut();
    connect(tree_, &TopicTree::ticked, this, &PlotsPanel::tick);
    connect(tree_, &TopicTree::told, message_, [this](const QString &text) {
        message_->tell(text);
        message_->setVisible(!text.isEmpty());
    });
    connect(tree_, &TopicTree::topicChosen, this, &PlotsPanel::showPage);
    connect(suggestions_, &PlotSuggestions::wanted, this, [this](const std::vector<FieldId> &fields) {
        plot(fields);
        board_->panes().front()->setFocus(); // what had it is gone; the keys drive from here
    });
    connect(board_, &PlotBoard::changed, this, &PlotsPanel::onBoardChanged);
    connect(&board_->time(), &TimeWindow::changed, this, &PlotsPanel::showTime);
    connect(sets_, &PlotSets::chosen, this, &PlotsPanel::setState);
    connect(sets_, &PlotSets::saveWanted, this, [this](const QString &name) { sets_->save(name, state()); });
    connect(&timer_, &QTimer::timeout, this, &PlotsPanel::redraw);
    timer_.start(std::chrono::milliseconds(100));
    showPage();
    showTime();
}

void PlotsPanel::layOut() {
    auto *const left = new QWidget;
    auto *const column = new QVBoxLayout(left);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(tree_, 1);
    column->addWidget(message_);
    pages_->addWidget(new ScrolledPanel(suggestions_));
    pages_->addWidget(new ScrolledPanel(board_)); // many charts do not make the window higher
    pages_->addWidget(newest_);
    auto *const right = new QWidget;
    auto *const rows = new QVBoxLayout(right);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->setSpacing(2);
    rows->addWidget(makeButtons());
    rows->addWidget(pages_, 1);
    auto *const splitter = new QSplitter;
    splitter->addWidget(left);
    splitter->addWidget(right);
    splitter->setStretchFactor(1, 3);
    splitter->setSizes({350, 650});
    auto *const layout = new QVBoxLayout(this);
    layout->setContentsMargins(4, 4, 4, 4);
    layout->addWidget(splitter);
}

QWidget *PlotsPanel::makeButtons() {
    auto *const row = new QWidget;
    auto *const layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(3);
    pause_ = new QPushButton(theme::icon("pause"), tr("Pa&use"));
    pause_->setObjectName("pause");
    pause_->setCheckable(true);
    pause_->setToolTip(tr("The picture stands still; sampling goes on"));
    connect(pause_, &QPushButton::clicked, this, [this](bool isOn) { board_->time().setHeld(isOn); });
    auto *const live = new QPushButton(theme::icon("follow"), tr("Live"));
    live->setObjectName("live");
    live->setToolTip(tr("Shows what comes, with all values in sight (also a double click on a chart)"));
    connect(live, &QPushButton::clicked, board_, &PlotBoard::goLive);
    layout->addWidget(pause_);
    layout->addWidget(live);
    span_ = addMenuButton(*row, "", {}, makeSpans());
    span_->setObjectName("span");
    span_->setAccessibleName(tr("Time that is shown"));
    span_->setToolTip(tr("The time that is shown, in seconds or minutes (also the wheel over a chart)"));
    addMenuButton(*row, "layers", tr("Panes"), makePanes())
        ->setToolTip(tr("Charts one below the other; new curves go to the chosen one"));
    addMenuButton(*row, "save", tr("Sets"), sets_)->setToolTip(tr("Plots that are kept by name"));
    addMenuButton(*row, "export", tr("Export"), makeExports())
        ->setToolTip(tr("Writes the curves to a file on this computer"));
    showMessage_ = new QPushButton(tr("Message"));
    showMessage_->setObjectName("showMessage");
    showMessage_->setCheckable(true);
    showMessage_->setToolTip(tr("The newest message of the topic that is chosen on the left"));
    connect(showMessage_, &QPushButton::toggled, this, &PlotsPanel::showPage);
    layout->addWidget(showMessage_);
    layout->addStretch(1);
    return row;
}

QToolButton *PlotsPanel::addMenuButton(QWidget &row, const char *icon, const QString &text, QMenu *menu) {
    auto *const button = new QToolButton;
    button->setText(text);
    if (*icon)
        button->setIcon(theme::icon(icon));
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setPopupMode(QToolButton::InstantPopup);
    button->setFocusPolicy(Qt::StrongFocus);
    button->setMenu(menu);
    row.layout()->addWidget(button);
    return button;
}

QMenu *PlotsPanel::makeSpans() {
    auto *const menu = new QMenu(this);
    for (const double span_s : {5, 10, 30, 60, 120, 300, 600})
        menu->addAction(spanText(span_s), this, [this, span_s] { board_->time().setSpan(span_s); });
    return menu;
}

QMenu *PlotsPanel::makePanes() {
    auto *const menu = new QMenu(this);
    QAction *const add = menu->addAction(theme::icon("add"), tr("Add a pane"), board_, &PlotBoard::addPane);
    add->setObjectName("addPane");
    QAction *const remove = menu->addAction(theme::icon("remove"), {}, board_, &PlotBoard::removePane);
    remove->setObjectName("removePane");
    connect(menu, &QMenu::aboutToShow, this, [this, add, remove] {
        add->setEnabled(board_->canAddPane());
        remove->setText(board_->panes().size() > 1 ? tr("Remove the chosen pane") : tr("Remove all curves"));
    });
    return menu;
}

QMenu *PlotsPanel::makeExports() {
    auto *const menu = new QMenu(this);
    menu->addAction(tr("Table of the last ten minutes (CSV)..."), this,
                    [this] { askFile(tr("Write the curves"), "curves.csv", tr("Tables (*.csv)")); })
        ->setObjectName("csv");
    menu->addAction(tr("Picture of what is shown (SVG or PNG)..."), this,
                    [this] { askFile(tr("Write the picture"), "curves.svg", tr("Pictures (*.svg *.png)")); })
        ->setObjectName("picture");
    return menu;
}

void PlotsPanel::tick(const FieldId &field, bool isOn) {
    if (!isOn)
        return board_->remove(field);
    if (board_->add(field))
        return;
    message_->tell(tr("No more than %1 curves.").arg(PlotBoard::maxCurves), true);
    onBoardChanged();
}

void PlotsPanel::plot(const std::vector<FieldId> &fields) {
    for (const FieldId &field : fields)
        tick(field, true);
}

void PlotsPanel::onBoardChanged() {
    std::vector<FieldId> plotted;
    for (const auto &[field, samples] : board_->sampler().all())
        plotted.push_back(field);
    tree_->showTicks(plotted);
    showPage();
}

void PlotsPanel::showTime() {
    pause_->setChecked(board_->time().isHeld());
    span_->setText(spanText(board_->time().span_s()));
}

void PlotsPanel::showPage() {
    if (showMessage_->isChecked()) {
        const auto [daemon, topic] = tree_->chosenTopic();
        newest_->follow(daemon, topic);
        setFocusProxy(nullptr);
        pages_->setCurrentWidget(newest_);
        return;
    }
    const bool isEmpty = board_->curves() == 0 && board_->panes().size() == 1;
    pages_->setCurrentIndex(isEmpty ? 0 : 1);
    setFocusProxy(isEmpty ? nullptr : board_->panes().front()); // who looks at curves may go on driving
}

void PlotsPanel::redraw() {
    if (!isSeen(*board_))
        return;
    board_->redraw();
    if (const quint64 unusable = board_->sampler().unusable(); unusable > 0)
        message_->tell(tr("%1 values cannot be plotted: no numbers, or too large.").arg(unusable));
}

void PlotsPanel::askFile(const QString &title, const QString &name, const QString &kinds) {
    askForFile(export_, this, title, name, kinds, [this](const QString &file) { write(file); });
}

void PlotsPanel::write(const QString &file) {
    writeBeside(drawn(file), this, [this, file](const Result<void> &done) {
        message_->tell(done ? tr("Wrote %1").arg(file) : done.error().message, !done);
    });
}

Writing PlotsPanel::drawn(const QString &file) const {
    if (file.endsWith(".csv", Qt::CaseInsensitive))
        return [file, kept = board_->kept()] { return writeCurves(file, kept); };
    return picture(file, tr("Hermes plots"), board_->size(),
                   [this](QPainter &painter) { board_->render(painter); });
}

} // namespace hermes::desktop
