//! The weight blob: golden bytes, every kind of damage, every refusal, and a stranger's decoder.

mod arbitrary;
mod buffer;
mod cases;
mod check;
mod damage;
mod golden;
mod refusals;
mod stranger;
