// The style sheet of report.html: narrow screens first, then wide ones, then A4.
#pragma once

#include <string_view>

namespace gnomon {

inline constexpr std::string_view kReportStyle = R"css(:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: #1c1b20;
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, Arial, sans-serif; }
main, footer { max-width: 58rem; margin: 0 auto; padding: 1rem; overflow-wrap: anywhere; }
h1 { font-size: 1.8rem; line-height: 1.2; margin: 0.5rem 0 0.25rem; }
h2 { font-size: 1.35rem; line-height: 1.25; margin: 2.2rem 0 0.6rem; padding-top: 0.7rem;
  border-top: 2px solid #1c1b20; }
h3 { font-size: 1.05rem; margin: 1.5rem 0 0.4rem; }
p { margin: 0.5rem 0; max-width: 46rem; }
a { color: #174e94; }
.subtitle { font-size: 1.1rem; color: #45434b; }
nav ul { padding-left: 1.2rem; columns: 14rem; }
dl { margin: 0.5rem 0 1rem; }
dt { color: #55535c; font-size: 0.9rem; }
dd { margin: 0 0 0.5rem; white-space: pre-line; }
.box { overflow-x: auto; }
.tall { max-height: 28rem; overflow-y: auto; border: 1px solid #c9c8ce; }
.tall thead th { position: sticky; top: 0; }
table { border-collapse: collapse; font-size: 0.9rem; line-height: 1.35; overflow-wrap: normal; }
th, td { text-align: left; vertical-align: top; padding: 0.25rem 0.7rem 0.25rem 0.4rem;
  border-bottom: 1px solid #dddce2; font-variant-numeric: tabular-nums; }
td { overflow-wrap: break-word; }
th { background: #f2f1f4; white-space: nowrap; }
.n { text-align: right; white-space: nowrap; }
thead td.bar { background: #f2f1f4; }
td.bar { width: 60%; min-width: 2.5rem; vertical-align: middle; }
td.bar svg { display: block; width: 100%; height: 0.8rem; overflow: visible; }
.note, figcaption, footer { color: #45434b; font-size: 0.9rem; }
figure { margin: 1.2rem 0; }
figcaption { margin-top: 0.4rem; max-width: 46rem; }
img { display: block; width: 100%; height: auto; }
.sun svg { display: block; width: 100%; max-width: 34rem; height: auto; }
footer { border-top: 1px solid #c9c8ce; }
@media (max-width: 30rem) {
  th, td { padding-left: 0.2rem; padding-right: 0.4rem; font-size: 0.8rem; }
}
@media (min-width: 40rem) {
  dl > div { display: grid; grid-template-columns: 13rem 1fr; gap: 1rem; }
  dt { font-size: 1rem; }
  dd { margin: 0 0 0.15rem; }
}
@page { size: A4; margin: 16mm 15mm 18mm;
  @bottom-right { content: counter(page) " / " counter(pages); font: 8pt sans-serif; } }
@media print {
  body { font-size: 10pt; }
  main, footer { max-width: none; padding: 0; }
  h2 { margin-top: 7mm; }
  h1, h2, h3 { break-after: avoid; }
  .date + .date, .inputs { break-before: page; }
  .box { overflow: visible; }
  .tall { max-height: none; border: 0; }
  .tall thead th { position: static; }
  thead { display: table-header-group; }
  tr, figure, dl > div { break-inside: avoid; }
  dt { font-size: inherit; }
  td { overflow-wrap: anywhere; }
  .note, figcaption { break-before: avoid; }
  p { orphans: 3; widows: 3; }
  th, td { padding-top: 0.6mm; padding-bottom: 0.6mm; }
  a { color: inherit; text-decoration: none; }
  .screen { display: none; }
  img { width: auto; max-width: 100%; max-height: 225mm; margin: 0 auto; }
  .sun svg { max-width: 130mm; }
}
)css";

}  // namespace gnomon
