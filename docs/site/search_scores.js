// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Scores of Sphinx's search, with an addition. Many pages have the words of a question, and Sphinx
// sorts equal scores by title; pages that answer users come before reference and design with them.
var Scorer = {
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
  score: ([page, , , , score]) =>
    score + (/^((get_started|how_to|troubleshooting|tutorials)\/|limits$)/.test(page) ? 3 : 0),
};
