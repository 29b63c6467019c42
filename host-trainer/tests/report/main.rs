//! The report, from plain data to a page that a browser plays.

mod browser;
mod fixture;
mod loops;
mod page;
mod pictures;
mod webdriver;
