#include "gui/desktop/panels/PlotsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/MessageView.h"
#include "gui/desktop/panels/PlotSets.h"
#include "gui/desktop/panels/PlotSuggestions.h"
#include "gui/desktop/panels/TopicTree.h"
#include "gui/desktop/view/PlotPane.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/desktop/widgets/ScrolledPanel.h"
#include "gui/desktop/widgets/Seen.h"

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
    pages_->addWidget(new ScrolledPanel(suggestions_));
    pages_->addWidget(new ScrolledPanel(board_)); // many charts do not make the window higher
    pages_->addWidget(newest_);
    auto *const splitter = new QSplitter;
    splitter->addWidget(filled(new QWidget, inColumn({{tree_, 1}, message_})));
    splitter->addWidget(filled(new QWidget, inColumn({makeButtons(), {pages_, 1}}), 2));
    splitter->setStretchFactor(1, 3);
    splitter->setSizes({350, 650});
    filled(this, inColumn({splitter}));
    layout()->setContentsMargins(4, 4, 4, 4);
}

QLayout *PlotsPanel::makeButtons() {
    pause_ = named(new QPushButton(theme::icon("pause"), tr("Pa&use")), "pause",
                   tr("The picture stands still; sampling goes on"));
    pause_->setCheckable(true);
    connect(pause_, &QPushButton::clicked, this, [this](bool isOn) { board_->time().setHeld(isOn); });
    auto *const live =
        named(new QPushButton(theme::icon("follow"), tr("Live")), "live",
              tr("Shows what comes, with all values in sight (also a double click on a chart)"));
    connect(live, &QPushButton::clicked, board_, &PlotBoard::goLive);
    span_ = named(menuButton({}, {}, makeSpans()), "span",
                  tr("The time that is shown, in seconds or minutes (also the wheel over a chart)"));
    span_->setAccessibleName(tr("Time that is shown"));
    QToolButton *const panes = menuButton(tr("Panes"), theme::icon("layers"), makePanes());
    panes->setToolTip(tr("Charts one below the other; new curves go to the chosen one"));
    QToolButton *const sets = menuButton(tr("Sets"), theme::icon("save"), sets_);
    sets->setToolTip(tr("Plots that are kept by name"));
    QToolButton *const exports = menuButton(tr("Export"), theme::icon("export"), makeExports());
    exports->setToolTip(tr("Writes the curves to a file on this computer"));
    showMessage_ = named(new QPushButton(tr("Message")), "showMessage",
                         tr("The newest message of the topic that is chosen on the left"));
    showMessage_->setCheckable(true);
    connect(showMessage_, &QPushButton::toggled, this, &PlotsPanel::showPage);
    QLayout *const row = inRow({pause_, live, span_, panes, sets, exports, showMessage_, Part::room()});
    row->setSpacing(3);
    return row;
}

QMenu *PlotsPanel::makeSpans() {
    auto *const menu = new QMenu(this);
    for (const double span_s : {5, 10, 30, 60, 120, 300, 600})
        menu->addAction(spanText(span_s), this, [this, span_s] { board_->time().setSpan(span_s); });
    return menu;
}

QMenu *PlotsPanel::makePanes() {
    auto *const menu = new QMenu(this);
    QAction *const add =
        named(menu->addAction(theme::icon("add"), tr("Add a pane"), board_, &PlotBoard::addPane), "addPane");
    QAction *const remove =
        named(menu->addAction(theme::icon("remove"), {}, board_, &PlotBoard::removePane), "removePane");
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
