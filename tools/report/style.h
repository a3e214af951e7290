// Purpose: the look of the report: light and dark, colours that colour-blind people can tell apart (Okabe and Ito),
// each system
//          with a dash of its own as well.
#pragma once

namespace report {

inline constexpr const char* kStyle = R"css(
:root{color-scheme:light dark;--bg:#fff;--card:#f6f7f9;--text:#1b1f24;--dim:#57606a;--rule:#d5d9de;--truth:#1b1f24;--grey:#8a929b;
--s0:#0072b2;--s1:#c84e00;--s2:#00815d;--s3:#a8558a;--s4:#8a6d00;--warn:#b3261e;--limit:#00815d}
@media (prefers-color-scheme:dark){:root{--bg:#0f1317;--card:#171c22;--text:#e6e9ec;--dim:#a3acb5;--rule:#2f363e;--truth:#f2f4f6;
--grey:#7d8790;--s0:#56b4e9;--s1:#ff9447;--s2:#3ccf9f;--s3:#e69ac6;--s4:#f0d442;--warn:#ff8a80;--limit:#3ccf9f}}
*{box-sizing:border-box}
body{margin:0;background:var(--bg);color:var(--text);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Liberation Sans",sans-serif}
main{max-width:1320px;margin:0 auto;padding:16px}
h1{font-size:1.7rem;line-height:1.2;margin:.3em 0}
h2{font-size:1.25rem;margin:2em 0 .3em;border-top:1px solid var(--rule);padding-top:.7em}
h3{font-size:1.05rem;margin:1.1em 0 .4em}
p,li{max-width:78ch}
.warning{border-left:4px solid var(--warn);padding:.3em .8em;background:var(--card)}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(240px,100%),1fr));gap:12px}
.tile{background:var(--card);border-radius:8px;padding:12px 14px}
.value{font-size:1.5rem;font-weight:600;line-height:1.25}
.note{color:var(--dim);font-size:.85rem}
.key{display:inline-block;width:.8em;height:.8em;border-radius:2px;margin-right:.4em}
.key.s0{background:var(--s0)}.key.s1{background:var(--s1)}.key.s2{background:var(--s2)}.key.s3{background:var(--s3)}.key.s4{background:var(--s4)}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(360px,100%),1fr));gap:12px}
.two{max-width:880px}
figure{margin:0;background:var(--card);border-radius:8px;padding:8px;min-width:0}
figcaption{color:var(--dim);font-size:.85rem}
svg{display:block;width:100%;height:auto}
svg text{fill:var(--dim);font-size:11px;font-family:inherit}
svg .title{fill:var(--text);font-weight:600;font-size:12.5px}
svg .legend{fill:var(--text)}
svg .mid{text-anchor:middle}svg .end{text-anchor:end}
svg path{fill:none}
svg .grid path{stroke:var(--rule);stroke-width:.7}
svg .frame{stroke:var(--dim);stroke-width:1}
svg .line{stroke-width:1.6;stroke-linejoin:round}
svg .truth{stroke:var(--truth);stroke-width:1.3}
svg .line.truth{stroke-width:2.6;opacity:.55}
svg .grey{stroke:var(--grey)}
svg .s0{stroke:var(--s0)}
svg .s1{stroke:var(--s1);stroke-dasharray:7 2.5}
svg .s2{stroke:var(--s2);stroke-dasharray:2.5 2}
svg .s3{stroke:var(--s3);stroke-dasharray:9 2 2 2}
svg .s4{stroke:var(--s4);stroke-dasharray:12 4}
svg .solid{stroke-dasharray:none}
svg .faint{stroke-width:.8;opacity:.38;stroke-dasharray:none}
svg .area{stroke:none;opacity:.2}
svg .area.s0{fill:var(--s0)}svg .area.s1{fill:var(--s1)}svg .area.s2{fill:var(--s2)}svg .area.s3{fill:var(--s3)}svg .area.s4{fill:var(--s4)}
svg .area.limit{fill:var(--limit)}
svg .dots{stroke-linecap:round;stroke-dasharray:none;opacity:.65}
svg .warn{stroke:var(--warn);opacity:1}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums}
caption{text-align:left;color:var(--dim);padding:.2em 0}
th,td{padding:.25em .6em;text-align:right;border-bottom:1px solid var(--rule);white-space:nowrap}
thead th{color:var(--dim);font-weight:600;vertical-align:bottom;white-space:normal}
th:first-child{text-align:left}
.strip{display:flex;gap:8px;overflow-x:auto;padding-bottom:8px}
.strip figure{flex:0 0 auto}
.strip img{display:block;height:240px;width:auto;max-width:none}
pre{background:var(--card);border-radius:8px;padding:10px;overflow-x:auto;font-size:.82rem}
details{margin:.8em 0}summary{cursor:pointer;color:var(--dim);margin-bottom:.5em}
)css";

}  // namespace report
