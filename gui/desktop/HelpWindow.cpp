#include "gui/desktop/HelpWindow.h"

#include "gui/desktop/widgets/Arrangement.h"
#include <QFile>
#include <QRegularExpression>
#include <QTextBlock>
#include <QTextBrowser>

namespace hermes::desktop {
namespace {

/// Without the pictures, which show what one sees.
QString manual() {
    QFile file(":/help/desktop.md");
    if (!file.open(QIODevice::ReadOnly))
        return {};
    static const QRegularExpression picture("^!\\[[^\n]*\n", QRegularExpression::MultilineOption);
    return QString::fromUtf8(file.readAll()).remove(picture);
}

} // namespace

HelpWindow::HelpWindow(QWidget *parent)
    : QDialog(parent)
    , text_(named(new QTextBrowser, "helpText")) {
    setWindowTitle(tr("Help"));
    setObjectName("help");
    text_->setOpenLinks(false);
    text_->setMarkdown(manual());
    filled(this, inColumn({text_}));
    connect(text_, &QTextBrowser::anchorClicked, this, [this](const QUrl &link) {
        if (link.path().isEmpty() && link.hasFragment()) // a heading of this page
            showAt(QString(link.fragment()).replace('-', ' '));
    });
    resize(760, 560);
}

void HelpWindow::showAt(const QString &text) {
    show();
    raise();
    QTextDocument &document = *text_->document();
    QTextCursor found;
    for (QTextBlock block = document.begin(); block.isValid() && found.isNull(); block = block.next())
        if (block.blockFormat().headingLevel() > 0 && block.text().compare(text, Qt::CaseInsensitive) == 0)
            found = QTextCursor(block);
    if (found.isNull())
        found = document.find(text);
    found = found.isNull() ? QTextCursor(&document) : QTextCursor(found.block());
    text_->setTextCursor(QTextCursor(document.lastBlock())); // so that the place comes to the top
    text_->setTextCursor(found);
}

} // namespace hermes::desktop
