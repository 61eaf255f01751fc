// Page: a page's WebSocket. Messages are sent in order, pixels when there is capacity.

#include "connection.h"

namespace etendue::studio {

namespace websocket = beast::websocket;

void Page::begin(http::request<http::string_body> request) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own timeout
  websocket::stream_base::timeout times{};
  times.handshake_timeout = limits::patience;
  times.idle_timeout = std::chrono::seconds(60);
  times.keep_alive_pings = true;
  socket_.set_option(times);
  socket_.read_message_max(limits::message);
  socket_.auto_fragment(false);
  server_.pages.insert(shared_from_this());
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return self->lost();
    self->server_.studio.join(self);
    self->read();
  });
}

void Page::finish() {
  if (!socket_.is_open()) return lost();
  finishing_ = true;
  write();
}

void Page::end() {
  beast::error_code ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
}

void Page::lost() {
  if (std::exchange(lost_, true)) return;
  server_.studio.leave(*this);
  end();
  server_.pages.erase(shared_from_this());
  if (server_.ending && server_.pages.empty()) server_.farewell.cancel();
}

void Page::read() {
  if (reading_ || lost_ || unanswered_ >= limits::unanswered) return;
  reading_ = true;
  socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, size_t) {
    self->reading_ = false;
    if (error) return self->lost();
    if (!self->socket_.got_text() || self->finishing_) {  // pages send text only; requests at the end are ignored
      self->buffer_.consume(self->buffer_.size());
      return self->read();
    }
    ++self->unanswered_;
    std::string text = beast::buffers_to_string(self->buffer_.data());
    self->buffer_.consume(self->buffer_.size());
    self->buffer_.shrink_to_fit();
    self->server_.studio.request(self, std::move(text));
    self->read();
  });
}

void Page::answered() {
  asio::post(socket_.get_executor(), [self = shared_from_this()] {
    --self->unanswered_;
    self->read();
  });
}

void Page::send(std::shared_ptr<const std::string> words) {
  asio::post(socket_.get_executor(), [self = shared_from_this(), words = std::move(words)]() mutable {
    if (self->lost_) return;
    self->unsent_ += words->size();
    self->words_.push_back(std::move(words));
    // A page that does not read is disconnected; it reconnects when it can.
    if (self->unsent_ > limits::unsent && self->words_.size() > 1) return self->lost();
    self->write();
  });
}

void Page::frame_ready() {
  asio::post(socket_.get_executor(), [self = shared_from_this()] { self->write(); });
}

/// Starts the next write, one at a time: messages first, then the newest frame, with only the tiles that the page does not
/// have.
void Page::write() {
  if (writing_ || lost_) return;
  asio::const_buffer next;
  if (!words_.empty()) {
    socket_.text(true);
    next = asio::buffer(*words_.front());
  } else if (finishing_) {
    if (!std::exchange(closing_, true))
      socket_.async_close(websocket::close_code::going_away, [self = shared_from_this()](beast::error_code) { self->lost(); });
    return;
  } else {
    // Slots take turns, so that one with constant changes does not block the others.
    const auto frames = server_.studio.frames(*this);
    auto next_slot = frames.upper_bound(last_slot_);
    size_t tried = 0;
    for (; tried < frames.size(); ++tried, ++next_slot) {
      if (next_slot == frames.end()) next_slot = frames.begin();
      if (next_slot->second && next_slot->second != shown_[next_slot->first]) break;
    }
    if (tried == frames.size()) return;
    const auto& [slot, frame] = *next_slot;
    std::shared_ptr<const Frame>& shown = shown_[slot];
    const bool continues = shown && frame->continues(*shown);
    pixels_ = frame->message(continues ? shown->number() : 0, slot);
    shown = frame;
    last_slot_ = slot;
    socket_.binary(true);
    next = asio::buffer(pixels_);
  }
  writing_ = true;
  const bool words = !words_.empty();
  socket_.async_write(next, [self = shared_from_this(), words](beast::error_code error, size_t) {
    self->writing_ = false;
    if (error) return self->lost();
    if (words) {
      self->unsent_ -= self->words_.front()->size();
      self->words_.pop_front();
    } else {
      self->pixels_ = {};
    }
    self->write();
  });
}

}  // namespace etendue::studio
