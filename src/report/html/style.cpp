// The page's style sheet. Colours: Okabe and Ito's, made darker (on light) or lighter (on dark) until text in them has
// a contrast of 4.5 : 1, the last two arms' colours, which are not used for text, of 3 : 1; arms differ by their marks
// and the dash of their lines as well.

#include "report/html/page.hpp"

namespace credence::page {

namespace {

constexpr char text[] =
    R"(:root { --paper: #fff; --ink: #1b1f24; --soft: #57606a; --line: #d0d7de; --panel: #f6f8fa; --link: #0a5a9c;
  --s0: #00629f; --s1: #b34700; --s2: #00734f; --s3: #9a3f78; --s4: #b37a00; --s5: #3a8fc2; --band: #b6bec8; --joint: #dde2e8; --margin: #cfe8dc;
  --consistent: #00694a; --optimistic: #a84300; --pessimistic: #005a94; --mixed: #8f3a6e; --undecided: #57606a;
  --failed: #b3131d; }
@media screen and (prefers-color-scheme: dark) {
  :root { --paper: #14181d; --ink: #e6eaef; --soft: #a3adb8; --line: #3a424c; --panel: #1c2229; --link: #7cbcf0;
    --s0: #6ab7ec; --s1: #f09a5c; --s2: #4cc79a; --s3: #e39ac6; --s4: #f4d47c; --s5: #c4e3f7; --band: #535d69; --joint: #323a44; --margin: #1f4a3a;
    --consistent: #4cc79a; --optimistic: #f5a36a; --pessimistic: #7cbcf0; --mixed: #e39ac6; --undecided: #a3adb8;
    --failed: #ff9a94; }
}
* { box-sizing: border-box; }
html { color-scheme: light dark; scroll-behavior: smooth; -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; max-width: 75rem; padding: 1.5rem clamp(1rem, 3vw, 2.5rem) 4rem; background: var(--paper);
  color: var(--ink); font: 1rem/1.5 system-ui, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif;
  overflow-wrap: anywhere; }
h1, h2, h3, h4 { line-height: 1.25; text-wrap: balance; }
h1 { font-size: 1.8rem; margin: 0 0 .25rem; }
h2 { font-size: 1.4rem; margin: 2.5rem 0 .5rem; padding-top: 1rem; border-top: 2px solid var(--line); }
h3 { font-size: 1.15rem; margin: 2rem 0 .5rem; }
h4 { font-size: 1rem; margin: 1.25rem 0 .25rem; }
p, ul, ol, dl { margin: .4rem 0; max-width: 52rem; }
a { color: var(--link); }
:focus-visible { outline: 2px solid var(--link); outline-offset: 2px; }
.source { color: var(--soft); }
.lead { font-size: 1.25rem; font-weight: 600; }
.warnings { border-left: 4px solid var(--optimistic); padding: .5rem 1rem .5rem 2rem; background: var(--panel); }
.lines { white-space: pre-line; } p.warnings { padding-left: 1rem; }
.badge { white-space: nowrap; font-weight: 650; }
.consistent { color: var(--consistent); } .optimistic { color: var(--optimistic); }
.pessimistic { color: var(--pessimistic); } .mixed { color: var(--mixed); } .undecided { color: var(--undecided); }
.failed { color: var(--failed); }
.verdicts { list-style: none; padding: 0; max-width: none; }
.verdicts li { display: grid; grid-template-columns: minmax(0, 17rem) 9rem minmax(0, 1fr); gap: .25rem 1rem;
  padding: .6rem 0;
  border-top: 1px solid var(--line); break-inside: avoid; }
.verdicts p { margin: 0; max-width: none; }
.verdicts .badge { font-size: 1.1rem; }
.numbers { color: var(--soft); font-variant-numeric: tabular-nums; }
nav ol { columns: 20rem; padding-left: 1.5rem; max-width: none; }
nav .badge { font-size: .85rem; }
.scroll { overflow-x: auto; margin: .75rem 0 1.25rem; }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: .3rem; overflow-wrap: normal; position: sticky; left: 0; }
th, td { padding: .2rem .6rem; text-align: right; border-bottom: 1px solid var(--line); overflow-wrap: normal;
  white-space: nowrap; }
thead th { vertical-align: bottom; white-space: normal; font-weight: 600; color: var(--soft);
  border-bottom: 2px solid var(--line); }
th:first-child { text-align: left; padding-left: 0; }
tbody th { font-weight: 400; } th[scope=row] { white-space: normal; min-width: 7rem; max-width: 15rem; }
.group th { font-weight: 600; padding-top: .6rem; }
#provenance ~ .scroll :is(th, td) { text-align: left; white-space: normal; overflow-wrap: anywhere; }
details { margin: .5rem 0; }
summary { cursor: pointer; color: var(--link); padding: .2rem 0; }
pre { background: var(--panel); border: 1px solid var(--line); padding: .6rem .8rem; overflow-x: auto;
  font-size: .85rem;
  margin: .4rem 0; white-space: pre-wrap; }
dt { font-weight: 600; margin-top: .6rem; } dd { margin: 0 0 0 1rem; }
.legend { font-size: .95rem; } .legend > span { margin-right: 1.5rem; white-space: nowrap; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 21rem), 1fr)); gap: 1rem 1.5rem;
  margin: .5rem 0 1rem; }
.charts:has(> figure:nth-child(2):last-child) { grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr));
  }
figure { margin: 0; max-width: 28rem; break-inside: avoid; } figcaption { font-size: .875rem; font-weight: 600; }
svg { display: block; width: 100%; height: auto;
  font: 11px system-ui, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
.label { fill: var(--soft); } .row { fill: var(--ink); } .name { fill: var(--ink); }
.halo { fill: var(--ink); paint-order: stroke; stroke: var(--paper); stroke-width: 3px; }
.axis { stroke: var(--soft); fill: none; } .grid { stroke: var(--line); stroke-width: .6; }
.ideal { stroke: var(--ink); stroke-width: 1; stroke-dasharray: 1 2.5; } .margin { fill: var(--margin); }
.band { fill: var(--band); fill-opacity: .75; } .joint { fill: var(--joint); }
.s0, .s6 { --own: var(--s0); } .s1, .s7 { --own: var(--s1); } .s2, .s8 { --own: var(--s2); }
.s3, .s9 { --own: var(--s3); } .s4, .s10 { --own: var(--s4); } .s5, .s11 { --own: var(--s5); }
.line, .whisker { fill: none; stroke: var(--own, var(--ink)); stroke-width: 1.5; } .whisker { stroke-width: 2.2; }
.line:is(.s1, .s10) { stroke-dasharray: 5 2.5; } .line:is(.s2, .s11) { stroke-dasharray: 2 2; }
.line:is(.s3, .s6) { stroke-dasharray: 9 2 2 2; } .line:is(.s4, .s7) { stroke-dasharray: 12 3; }
.line:is(.s5, .s8) { stroke-dasharray: 6 2 1.5 2 1.5 2; }
.mark, .bar, .spread { fill: var(--own); } .mark { stroke: var(--paper); stroke-width: .8; }
.mark.hollow { fill: var(--paper); stroke: var(--own); stroke-width: 1.6; }
.mark:hover { stroke: var(--ink); stroke-width: 1.5; } .mark.pair { fill: var(--ink); }
.bar { fill-opacity: .8; } .bar:hover { fill-opacity: 1; } .pair { fill: var(--soft); } .spread { fill-opacity: .22; }
.key { display: inline-block; width: 36px; vertical-align: -.1em; }
.median { stroke: var(--ink); stroke-width: 2; } .published { stroke: var(--ink); stroke-width: 1.5;
  stroke-dasharray: 4 2; }
@media (max-width: 44rem) { .verdicts li { grid-template-columns: 1fr; gap: 0; } h1 { font-size: 1.45rem; } }
@media print {
  @page { margin: 14mm; }
  html { color-scheme: light; }
  body { max-width: none; padding: 0; font-size: 9.5pt; }
  h2 { margin-top: 1.2rem; } h2, h3, h4, h4 + p, caption, figcaption, thead { break-after: avoid; }
  .scenario ~ .scenario { break-before: page; } .scroll { overflow: visible; } tr, pre { break-inside: avoid; }
  pre { break-inside: auto; }
  table { font-size: 7pt; } th, td { padding: .12rem .35rem; } th:first-child { padding-left: 0; }
  .charts, .charts:has(> figure:nth-child(2):last-child) { grid-template-columns: 1fr 1fr; gap: .6rem 1.2rem; }
  .verdicts li { grid-template-columns: 12rem 8rem 1fr; }
  details:not(.printed), .screen { display: none; }
  details.printed > summary { list-style: none; color: inherit; }
  details.printed::details-content { content-visibility: visible; display: block; }
  .printed pre { columns: 2; font-size: 7.5pt; }
  a { color: inherit; text-decoration: none; }
}
)";

}  // namespace

std::string_view style_sheet() { return text; }

}  // namespace credence::page
