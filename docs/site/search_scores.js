// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Scores of Sphinx's search, with two additions. A heading that has the query as it was typed, such as
// the text of an error, comes before pages that have its words in any place. Many pages have the words
// of a question, and Sphinx sorts equal scores by title: pages that answer users come before reference
// and design.
var Scorer = {
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
  score: ([page, , , , score, , kind]) =>
    score +
    (kind === "title" ? 15 : 0) +
    (/^((get_started|how_to|troubleshooting|tutorials)\/|limits$)/.test(page) ? 3 : 0),
};
