// SPDX-License-Identifier: BSD-3-Clause
/**
 * The result in one sentence: who keeps the length, who loses it, and where. To keep it is to succeed, within 5 % of the
 * distance at every instant, with a length within 1 %; to fail is not to succeed.
 */
import { formatNumber, isNumber } from "./format";

/** What is known of an estimator. */
export interface Finding {
  name: string;
  success: boolean;
  /** Error of the length between reference points, M_list [%]; null: none. */
  percent: number | null;
  /** The worst of several runs, of which `percent` is the median; null: of one run. */
  worst: number | null;
  /** With its sign: negative is too short. */
  signed: number | null;
  /** Heading-aligned ATE [m]. */
  ate: number | null;
  /** Where it is lost for good; null if it is not. */
  loss: { from: number; distance: number; most: number; scaled: boolean } | null;
  /** Largest error in the direction that fails where the length does not show it [m]. */
  aside: { direction: "height" | "sideways"; most: number } | null;
  /** What constrained the weak axis there: median of the equivalent returns; null: not known. */
  returns: number | null;
  /** What is missing of it where it fails by that: "has no poses for 12 s, from 34 s on". */
  missing?: string | null;
  /** Of several runs, on how many it fails: "2 of 3 seeds". */
  fails?: string | null;
  /** Of several runs, on how many it succeeds. */
  successes?: number;
  /** Healthy all along, as it says itself. */
  healthy: boolean;
}

/** What the lengths belong to, and how far the robot walked [m]. */
export interface Route {
  corridor: boolean;
  length: number;
}

/** As good as the best: within this factor of it, or below this [%]. */
const kFactor = 2;
const kAlike = 0.1;
/** More than this is a loss of the length [%]. */
const kWrong = 1;

/** A success is within this of the distance travelled [%]. */
const kSuccess = 5;

const percentText = (value: number) => `${formatNumber(value, 2)} %`;

/** The most of their medians and, over several runs, of their worst. */
function mostText(list: Finding[]): string {
  const most = percentText(Math.max(...list.map((each) => each.percent!)));
  const worst = list.map((each) => each.worst).filter(isNumber);
  return worst.length > 0 ? `${most} in the median and ${percentText(Math.max(...worst))} at worst` : most;
}

function listed(names: string[]): string {
  if (names.length < 2) return names.join("");
  return `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}`;
}

/** By name if they are few. */
function namesOf(list: Finding[]): string {
  return list.length <= 3 ? listed(list.map((each) => each.name)) : `${list.length} more`;
}

/** The rest: those that fail, "too" where a shown one does, and those whose length alone is wrong. */
function moreText(list: Finding[], shown: Finding[]): string[] {
  const failed = list.filter((each) => !each.success);
  const inexact = list.filter((each) => each.success);
  const texts: string[] = [];
  if (failed.length > 0) {
    const too = shown.some((each) => !each.success) ? ", too" : "";
    texts.push(`${namesOf(failed)} ${failed.length === 1 ? "fails" : "fail"}${too}`);
  }
  if (inexact.length > 0)
    texts.push(`${namesOf(inexact)} ${inexact.length === 1 ? "succeeds" : "succeed"}, more than ${kWrong} % off`);
  return texts;
}

/** Those that succeed, but whose scores are of parts of the runs. */
function partial(list: Finding[]): Finding[] {
  return list.filter((each) => each.success && each.missing && each.percent === null && each.ate === null);
}

/** What no estimator does; the limit of a length that is kept, or of a success. */
function noneText(list: Finding[], what: string): string {
  if (partial(list).length > 0) return `No estimator with poses of every run keeps ${what} within ${kWrong} %`;
  if (!list.some((each) => each.percent !== null && each.percent <= kWrong)) return `No estimator keeps ${what} within ${kWrong} %`;
  return list.some((each) => each.success) ? `No estimator that succeeds keeps ${what} within ${kWrong} %` : noSuccess(list, "No estimator succeeds");
}

/** Of one run `text`; over several, that none succeeds on most. */
function noSuccess(list: Finding[], text: string): string {
  return list.some((each) => each.fails) ? "No estimator succeeds on more than half of the seeds" : text;
}

/** What constrains the axis where an estimate is lost. */
function place(returns: number | null): string {
  if (returns === null) return "";
  if (returns < 10) return ", where the walls constrain nothing along the way";
  if (returns < 100) return ", where fewer than 100 equivalent returns constrain the way";
  return "";
}

function asideText({ name, percent, aside, fails }: Finding, unnoticed: string): string {
  const off = aside!.direction === "height" ? "off in height" : "off sideways";
  const length = percent === null ? "" : `, its length by ${percentText(percent)}`;
  const is = fails ? `fails on ${fails},` : "is";
  return `${name} ${is} up to ${formatNumber(aside!.most, 2)} m ${off}${length}${unnoticed}`;
}

function lossText(each: Finding, route: Route): string {
  const unnoticed = each.healthy ? ", and calls itself healthy" : "";
  const { loss, percent, signed } = each;
  if (!each.success && each.missing) return `${each.name} ${each.missing}`;
  if (loss && loss.most > 2 * route.length)
    return `${each.name} is lost from ${loss.from.toFixed(0)} s on${place(each.returns)}`;
  if (!each.success && each.aside && (percent ?? 0) <= kSuccess) return asideText(each, unnoticed);
  if (!each.success && each.fails && percent !== null)
    return `${each.name} fails on ${each.fails}, its length ${percentText(percent)} off in the median`;
  if (percent !== null && (!loss || loss.scaled)) {
    const side = signed === null ? "off" : signed < 0 ? "short" : "too long";
    const when = each.worst === null ? "throughout" : "in the median";
    const fails = each.fails ? ` and ${each.missing ?? `fails on ${each.fails}`}` : "";
    return `${each.name} is ${percentText(percent)} ${side} ${when}${fails}${unnoticed}`;
  }
  if (!loss) return `${each.name} fails`;
  const verb = signed !== null && signed < 0 ? "loses" : "strays by";
  const where = `from ${loss.from.toFixed(0)} s on (after ${loss.distance.toFixed(0)} m)`;
  return `${each.name} ${verb} ${formatNumber(loss.most, 2)} m ${where}${place(each.returns)}${unnoticed}`;
}

/** Those that lose the length, the most telling first: failed before inexact, lost at a place before wrong throughout. */
function losers(list: Finding[]): Finding[] {
  const wrong = list.filter((each) => !each.success || (each.percent ?? 0) > kWrong);
  const rank = (each: Finding) => (each.success ? 2 : 0) + (each.loss && !each.loss.scaled ? 0 : 1);
  return wrong.sort((a, b) => rank(a) - rank(b) || (b.percent ?? 0) - (a.percent ?? 0));
}

/** Whether over several runs their worst are as near to each other as their medians. */
function worstAlike(list: Finding[]): boolean {
  const worst = list.map((each) => each.worst).filter(isNumber);
  return Math.max(...worst) <= Math.max(kAlike, kFactor * Math.min(...worst)) || worst.length === 0;
}

/** Empty without scores. */
export function finding(list: Finding[], route: Route): string {
  const known = list.filter((each) => each.percent !== null);
  if (known.length === 0) return withoutLengths(list);
  const what = route.corridor ? "the corridor's length" : "the distances between the reference points";
  const good = known.filter((each) => each.success && each.percent! <= kWrong)
    .sort((a, b) => Number(Boolean(a.fails)) - Number(Boolean(b.fails)) || a.percent! - b.percent!);
  const bad = losers(list);
  const shown = bad.slice(0, 2).map((each) => lossText(each, route));
  shown.push(...moreText(bad.slice(2), bad.slice(0, 2)));
  shown.push(...good.filter((each) => each.fails).map((each) => `${each.name} ${each.missing ?? `fails on ${each.fails}`}`));
  shown.push(...partial(list).map((each) => `${each.name} ${each.missing} and succeeds on ${each.successes}`));
  const loss = shown.length > 0 ? `; ${shown.join("; ")}` : "";
  if (good.length === 0) return `${noneText(list, what)}${loss}.`;
  const limit = Math.max(kAlike, kFactor * good[0]!.percent!);
  const near = good.filter((each) => each.percent! <= limit);
  const worstLimit = Math.max(kAlike, kFactor * Math.min(...near.map((each) => each.worst ?? 0)));
  const best = near.filter((each) => (each.worst ?? 0) <= worstLimit);
  const rest = good.length > best.length
    ? `, ${listed(good.filter((each) => !best.includes(each)).slice(0, 3).map((each) => `${each.name} within ${mostText([each])}`))}` : "";
  const names = listed(best.map((each) => each.name));
  if (shown.length === 0 && best.length === list.length && list.length > 1 && worstAlike(best)) {
    const runs = best[0]!.worst === null ? "this run does" : "these runs do";
    return `${names} ${list.length === 2 ? "both" : "all"} keep ${what} within ${mostText(best)}: ${runs} not separate them by it.`;
  }
  return `${names} keep${best.length === 1 ? "s" : ""} ${what} within ${mostText(best)}${rest}${loss}.`;
}

/** By the ATE, where no lengths were scored. */
function withoutLengths(list: Finding[]): string {
  const good = list.filter((each) => each.success && isNumber(each.ate)).sort((a, b) => a.ate! - b.ate!);
  const failed = list.filter((each) => !each.success);
  const texts = failed.slice(0, 2).map((each) => each.missing ? `${each.name} ${each.missing}` : each.aside ? asideText(each, "") : `${each.name} fails`);
  texts.push(...moreText(failed.slice(2), failed.slice(0, 2)));
  texts.push(...partial(list).map((each) => `${each.name} ${each.missing} and succeeds on ${each.successes}`));
  const loss = texts.length > 0 ? `; ${texts.join("; ")}` : "";
  if (good.length === 0 && texts.length === 0) return "";
  if (good.length === 0) return partial(list).length > 0 ? `${texts.join("; ")}.` : `${noSuccess(list, "No estimator stays near the truth from its start on")}${loss}.`;
  return `${good[0]!.name} stays ${list.length > 1 ? "nearest" : "near"} to the truth, ATE ${formatNumber(good[0]!.ate, 2)} m${loss}.`;
}
